#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace nextview {

/// The key that the processes of a run share (--key-file). With it every message bears a signature
/// behind its bytes, which LCM's decoders do not look at: BLAKE2b over channel and bytes, keyed
/// (libsodium's crypto_generichash). The same message has the same signature, so that a process
/// that was started again publishes the same bytes again. Who does not have the key can repeat what
/// was said in the run, which changes nothing, and say nothing else.
class RunKey {
 public:
  static constexpr std::size_t kSignatureBytes = 16;
  static constexpr std::size_t kLeastKeyBytes = 32;
  static constexpr std::size_t kMostKeyBytes = 4096;

  /// @param file with kLeastKeyBytes to kMostKeyBytes bytes nobody can guess, such as
  ///        `head -c 32 /dev/urandom` gives, for nobody's eyes but the owner's
  /// @throws BusError naming the file when it is not such a one
  static RunKey read(const std::filesystem::path& file);

  /// Puts the signature behind a message's bytes.
  void sign(std::string_view channel, std::vector<std::uint8_t>& bytes) const;
  /// Whether bytes end in their signature.
  bool has_signed(std::string_view channel, std::span<const std::uint8_t> bytes) const;

 private:
  using Signature = std::array<std::uint8_t, kSignatureBytes>;

  explicit RunKey(std::span<const std::uint8_t> secret);
  Signature signature_of(std::string_view channel, std::span<const std::uint8_t> bytes) const;

  std::array<std::uint8_t, 32> key_;
};

}  // namespace nextview
