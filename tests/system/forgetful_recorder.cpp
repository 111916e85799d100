// Stands in for lcm-logger, and misses every third message the first time it comes.
#include <csignal>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <set>
#include <string>

namespace {

volatile std::sig_atomic_t stop = 0;
void request_stop(int) { stop = 1; }

class Recorder {
 public:
  explicit Recorder(const std::string& file) : log_(file, "w") {}

  // A plain function, because LCM calls members through a type they do not have.
  static void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                      Recorder* recorder) {
    recorder->write(buffer, channel);
  }

  void write(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::string bytes(static_cast<const char*>(buffer->data), buffer->data_size);
    const bool first_time = seen_.insert(channel + bytes).second;
    const bool of_the_run = channel != "NEXTVIEW_REQUEST" && channel != "NEXTVIEW_STATUS";
    if (first_time && of_the_run && ++count_ % 3 == 0) {
      ++forgotten_;
      return;
    }
    lcm::LogEvent event;
    event.channel = channel;
    event.timestamp = buffer->recv_utime;
    event.data = buffer->data;
    event.datalen = static_cast<int>(buffer->data_size);
    log_.writeEvent(&event);
    std::fflush(log_.getFilePtr());
  }

  int forgotten() const { return forgotten_; }

 private:
  lcm::LogFile log_;
  std::set<std::string> seen_;
  int count_ = 0;
  int forgotten_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::string url;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.starts_with("--lcm-url=")) url = argument.substr(10);
  }
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigaction(SIGTERM, &action, nullptr);
  lcm::LCM lcm(url);
  if (!lcm.good()) return 1;
  Recorder recorder(argv[argc - 1]);
  lcm.subscribeFunction(".*", Recorder::receive, &recorder)->setQueueCapacity(0);
  while (stop == 0) lcm.handleTimeout(50);
  std::cerr << "forgot " << recorder.forgotten() << " messages" << std::endl;
}
