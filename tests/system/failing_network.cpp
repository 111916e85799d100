// Preloaded into a program, and not into those it starts: once the file that NEXTVIEW_NETWORK_FAILS
// names is there, the system takes nothing that is to be sent.
#include <dlfcn.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

__attribute__((constructor)) static void spare_those_it_starts() { ::unsetenv("LD_PRELOAD"); }

// LCM sends by this call.
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto send = reinterpret_cast<decltype(&sendmsg)>(::dlsym(RTLD_NEXT, "sendmsg"));
  const char* file = std::getenv("NEXTVIEW_NETWORK_FAILS");
  if (file != nullptr && ::access(file, F_OK) == 0) {
    errno = ENETUNREACH;
    return -1;
  }
  return send(socket, message, flags);
}
