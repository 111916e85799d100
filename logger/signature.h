#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "lcmtypes/run_key.h"

namespace nextview {

/// What a logged message says of who has published it (RunKey).
enum class Signature : std::uint8_t {
  None,       ///< there is none, and none is asked for
  Unchecked,  ///< there is one, as far as its length tells, and no key to check it with
  Right,      ///< of the key
  Wrong,      ///< there is none of the key: somebody else's, or altered
};

/// @param key of the run; nothing: nobody asks for signatures
Signature signature_of(std::string_view channel, std::span<const std::uint8_t> bytes,
                       const std::optional<RunKey>& key);

}  // namespace nextview
