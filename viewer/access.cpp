#include "viewer/access.h"

#include <string>

namespace nextview {

bool is_own_host(std::string_view host, std::uint16_t port) {
  std::string end = ":";
  end += std::to_string(port);
  return host == "127.0.0.1" + end || host == "localhost" + end;
}

bool is_own_origin(std::string_view origin, std::uint16_t port) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_own_host(origin.substr(kScheme.size()), port);
}

}  // namespace nextview
