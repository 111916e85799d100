#pragma once

#include <cstdint>
#include <string_view>

namespace nextview {

/// Whether a request is for this server, by its Host header, 127.0.0.1:PORT or localhost:PORT: a
/// page elsewhere whose name has been made to lead here (DNS rebinding) is refused.
bool is_own_host(std::string_view host, std::uint16_t port);

/// Whether it is a page of this server that wants to talk to it, by its Origin header. Browsers let
/// any page open a WebSocket to anywhere, and say only here whose page it is. None is refused too.
bool is_own_origin(std::string_view origin, std::uint16_t port);

}  // namespace nextview
