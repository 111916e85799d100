#pragma once

#include <string_view>

namespace nextview {

/// The version of the programs and the git commit they were built from, such as "0.2 ab12cd34ef56";
/// with a "+" where the checkout had changes, the version alone outside a checkout.
std::string_view program_version();

}  // namespace nextview
