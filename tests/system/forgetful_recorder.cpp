// Stands in for lcm-logger, and misses every third message the first time it comes; with a
// channel's name in NEXTVIEW_NEVER_RECORDED nothing but the first message on that channel, however
// often it comes.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <set>
#include <string>
#include <utility>

namespace {

volatile std::sig_atomic_t stop = 0;
void request_stop(int) { stop = 1; }

class Recorder {
 public:
  Recorder(const std::string& file, std::string never)
      : log_(file, "w"), never_(std::move(never)) {}

  // A plain function, because LCM calls members through a type they do not have.
  static void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                      Recorder* recorder) {
    recorder->write(buffer, channel);
  }

  void write(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::string bytes(static_cast<const char*>(buffer->data), buffer->data_size);
    if (never_.empty() ? forgets(channel, bytes) : overlooks(channel, bytes)) {
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
  bool forgets(const std::string& channel, const std::string& bytes) {
    const bool first_time = seen_.insert(channel + bytes).second;
    const bool of_the_run = channel != "NEXTVIEW_REQUEST" && channel != "NEXTVIEW_STATUS";
    return first_time && of_the_run && ++count_ % 3 == 0;
  }

  bool overlooks(const std::string& channel, const std::string& bytes) {
    if (channel != never_) return false;
    if (overlooked_.empty()) overlooked_ = bytes;
    return bytes == overlooked_;
  }

  lcm::LogFile log_;
  std::string never_;
  std::string overlooked_;
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
  const char* never = std::getenv("NEXTVIEW_NEVER_RECORDED");
  Recorder recorder(argv[argc - 1], never == nullptr ? "" : never);
  lcm.subscribeFunction(".*", Recorder::receive, &recorder)->setQueueCapacity(0);
  while (stop == 0) lcm.handleTimeout(50);
  std::cerr << "forgot " << recorder.forgotten() << " messages" << std::endl;
}
