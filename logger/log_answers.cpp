#include "logger/log_answers.h"

#include <limits>
#include <set>
#include <type_traits>

#include "lcmtypes/decode.h"

namespace nextview {

void LogAnswers::answer(Bus& bus, const request_t& request) {
  if (request.view < 1 || request.view > views()) return;
  for_each_channel([&]<class Message>() {
    if constexpr (Channel<Message>::answered && requires(Message message) { message.view; }) {
      if (request.wanted_channel != Channel<Message>::name) return;
      const Place place = places_[static_cast<std::size_t>(request.view) - 1];
      std::set<MessageKey> said;
      reader_.seek(place.begin);
      while (reader_.position() < place.end) {
        const auto message = reader_.next();
        if (!message) break;
        if (message->channel != Channel<Message>::name) continue;
        const Decoded<Message> decoded = decode_checked<Message>(message->bytes);
        if (!decoded.message || decoded.message->run != bus.run_number()) continue;
        const MessageKey key = key_of(*decoded.message);
        const bool wanted =
            key.view == request.view && (request.attempt == 0 || request.attempt == key.attempt);
        if (wanted && said.insert(key).second) bus.publish(*decoded.message);
      }
      // The log keeps it, so that the bus need not.
      bus.forget_before<Message>(std::numeric_limits<int>::max());
    }
  });
}

}  // namespace nextview
