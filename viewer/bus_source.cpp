#include <chrono>
#include <optional>

#include "lcmtypes/ask_timer.h"
#include "lcmtypes/bus.h"
#include "lcmtypes/signed_transport.h"
#include "viewer/run_follower.h"
#include "viewer/run_source.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// The run of the first message that can be right.
std::optional<std::int64_t> run_on(const std::string& lcm_url, const std::optional<RunKey>& key,
                                   const std::stop_token& stop) {
  const std::unique_ptr<Transport> transport = transport_on(lcm_url, key);
  std::optional<std::int64_t> run;
  for_each_channel([&]<class Message>() {
    transport->subscribe(Channel<Message>::name, [&run](std::span<const std::uint8_t> bytes) {
      const Decoded<Message> decoded = decode_checked<Message>(bytes);
      if (decoded.message && !run) run = decoded.message->run;
    });
  });
  while (!run && !stop.stop_requested()) transport->handle(milliseconds(50));
  return run;
}

/// One run on its bus.
class RunOnBus {
 public:
  RunOnBus(Bus& bus, ViewedRun& viewed) : bus_(bus), viewed_(viewed), follower_(viewed) {
    listen<run_config_t>();
    // A planner that has only started has not heard of a pause yet.
    bus_.on<status_t>([this](const status_t& status) {
      if (status.role == "planner") tell_again_ = {};
    });
    tell_pace();  // before the run hears of this viewer
    bus_.request<run_config_t>(0, 0);
  }

  void follow(const std::stop_token& stop) {
    AskTimer reminder(milliseconds(100), milliseconds(2000));
    while (!follower_.has_config() && !stop.stop_requested()) {
      bus_.handle(milliseconds(20));
      tell_pace();
      if (reminder.due()) bus_.request<run_config_t>(0, 0);
    }
    // Nothing means anything without the configuration; what has come meanwhile is asked for.
    listen<goal_t>();
    listen<search_t>();
    listen<arrival_t>();
    listen<range_image_t>();
    listen<commit_t>();
    listen<stop_t>();
    AskTimer idle(milliseconds(300), milliseconds(4000));
    int present = follower_.next_view();
    bool asked = false;
    while (!stop.stop_requested()) {
      bus_.handle(milliseconds(20));
      tell_pace();
      if (follower_.ended()) continue;
      const bool waits = follower_.waits();
      if (follower_.next_view() != present) {
        // Of a run that was under way before, view by view, as fast as it is answered.
        if (waits && asked) {
          ask_for_present();
        } else {
          asked = false;
        }
        present = follower_.next_view();
        reminder.restart();
        idle.restart();
      } else if (waits && reminder.due()) {
        asked = true;
        ask_for_present();
      } else if (!waits && idle.due() && viewed_.pace() == kAnyView) {
        // Whether the run has got on, or has ended, unheard.
        bus_.request<commit_t>(present, 0);
        bus_.request<stop_t>(0, 0);
      }
    }
  }

 private:
  template <class Message>
  void listen() {
    bus_.on<Message>([this](const Message& message) { follower_.add(message); });
  }

  void ask_for_present() {
    const int view = follower_.next_view();
    if (follower_.lacks_commit()) bus_.request<commit_t>(view, 0);
    if (follower_.lacks_goal()) bus_.request<goal_t>(view, 0);
    if (follower_.lacks_arrival()) bus_.request<arrival_t>(view, 0);
    if (follower_.lacks_image()) bus_.request<range_image_t>(view, 0);
    if (view > 1) bus_.request<search_t>(view, 0);
  }

  /// Said again twice a second while the run is to wait; a viewer that gets no core for a while is
  /// not taken for dead.
  static constexpr double kHolds_s = 20.0;
  void tell_pace() {
    const int pace = viewed_.pace();
    const auto now = Clock::now();
    if (pace == told_ && (pace == kAnyView || now < tell_again_)) return;
    told_ = pace;
    tell_again_ = now + milliseconds(500);
    pace_t message{};
    // Of two viewers, or of one started anew, the one that speaks last counts.
    message.pace_number = std::chrono::duration_cast<std::chrono::microseconds>(
                              std::chrono::system_clock::now().time_since_epoch())
                              .count();
    message.last_view = pace;
    message.holds_s = kHolds_s;
    bus_.publish(message);
  }

  Bus& bus_;
  ViewedRun& viewed_;
  RunFollower follower_;
  int told_ = kAnyView;
  Clock::time_point tell_again_;
};

}  // namespace

void follow_bus(const std::string& lcm_url, std::int64_t run, const std::optional<RunKey>& key,
                ViewedRun& viewed, const std::stop_token& stop) {
  if (run == 0) {
    viewed.set_note("Nothing has been heard of a run yet.");
    run = run_on(lcm_url, key, stop).value_or(0);
    if (run == 0) return;
  }
  Bus bus(lcm_url, run, "viewer", key);
  RunOnBus(bus, viewed).follow(stop);
}

}  // namespace nextview
