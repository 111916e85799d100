#include "logger/log_answers.h"

#include <limits>

namespace nextview {

void LogAnswers::answer(Bus& bus, const request_t& request) {
  tell(request.wanted_channel, request.view, request.attempt, bus.run_number(),
       [&bus]<class Message>(const Message& message) {
         bus.publish(message);
         // The log keeps it, so that the bus need not.
         bus.forget_before<Message>(std::numeric_limits<int>::max());
       });
}

}  // namespace nextview
