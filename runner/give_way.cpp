#include "runner/give_way.h"

#include <sys/resource.h>
#include <unistd.h>

namespace nextview {

void give_way() { setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLookingOnNice); }

}  // namespace nextview
