#include "runner/earlier_run.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <type_traits>

#include "lcmtypes/program_version.h"
#include "scene/scene_config.h"

namespace nextview {
namespace {

run_config_t config_in(const std::filesystem::path& log, const std::optional<RunKey>& key) {
  LogReader reader(log, key);
  std::string reason;
  while (const auto message = reader.next()) {
    if (message->channel != Channel<run_config_t>::name) continue;
    if (message->signature == Signature::Unchecked) {
      throw SetupError("--resume: " + log.string() +
                       " is signed: name the run's key by --key-file");
    }
    if (!message->is_authentic()) {
      reason = " signed by this key (--key-file)";
      continue;
    }
    const Decoded<run_config_t> decoded = decode_checked<run_config_t>(message->message());
    if (!decoded.message) {
      reason = " that this version can read (" + decoded.reason + ")";
      continue;
    }
    const std::string version(program_version());
    if (decoded.message->program_version != version) {
      throw SetupError("--resume: " + log.string() + " was begun by nextview " +
                       decoded.message->program_version + "; this is " + version +
                       ", which might decide otherwise. Go on with that one, or start a new run");
    }
    return *decoded.message;
  }
  throw SetupError("--resume: " + log.string() + " holds no run's configuration" + reason +
                   ", and so nothing to go on from: start a new run");
}

}  // namespace

EarlierRun::EarlierRun(const std::filesystem::path& log, const std::optional<RunKey>& key)
    : reader_(log, key) {
  record_.add(config_in(log, key));
  std::int64_t position = 0;
  while (const auto message = reader_.next()) {
    for_each_channel([&]<class Message>() {
      if (message->channel == Channel<Message>::name) take_in<Message>(*message, position);
    });
    if (record_.stop() && record_.ends_early()) {
      // An early end is none any more, nor is what came after it.
      reader_.seek(position);
      reader_.cut_rest();
      record_.forget_stop();
      break;
    }
    position = reader_.position();
  }
  reader_.cut_rest();
}

template <class Message>
void EarlierRun::take_in(const LoggedMessage& message, std::int64_t position) {
  if constexpr (Channel<Message>::answered && !std::is_same_v<Message, run_config_t>) {
    if (!message.is_authentic()) return;
    const Decoded<Message> decoded = decode_checked<Message>(message.message());
    if (!decoded.message || decoded.message->run != config().run) return;
    try {
      record_.add(*decoded.message);
    } catch (const RejectedMessage&) {
      return;  // as whoever heard it did
    }
    if constexpr (std::is_same_v<Message, range_image_t>) {
      const range_image_t& part = *decoded.message;
      const auto bytes = static_cast<std::size_t>(16 * part.entries + 4 * part.pixels);
      part_bytes_ = std::max(part_bytes_, (bytes + 15) / 16 * 16);
    }
    positions_.try_emplace({Channel<Message>::name, key_of(*decoded.message)}, position);
  }
}

void EarlierRun::answer(Bus& bus, const request_t& request) {
  for_each_channel([&]<class Message>() {
    if constexpr (Channel<Message>::answered && !std::is_same_v<Message, run_config_t>) {
      if (request.wanted_channel != Channel<Message>::name) return;
      for (auto found =
               positions_.lower_bound({Channel<Message>::name, {request.view, request.attempt, 0}});
           found != positions_.end() && found->first.first == Channel<Message>::name &&
           found->first.second.view == request.view &&
           (request.attempt == 0 || found->first.second.attempt == request.attempt);
           ++found) {
        reader_.seek(found->second);
        const auto message = reader_.next();
        if (!message) return;
        const Decoded<Message> decoded = decode_checked<Message>(message->message());
        if (decoded.message) bus.publish(*decoded.message);
      }
      // The log keeps it, so that the bus need not.
      bus.forget_before<Message>(std::numeric_limits<int>::max());
    }
  });
}

RunSetup set_up_again(const run_config_t& config) {
  RunSetup setup;
  setup.config = config;
  if (config.has_scene) setup.scene = std::make_shared<const Scene>(load_scene(config));
  return setup;
}

}  // namespace nextview
