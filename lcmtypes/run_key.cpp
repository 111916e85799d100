#include "lcmtypes/run_key.h"

#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "lcmtypes/transport.h"

namespace nextview {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw BusError("--key-file " + file.string() + ": " + why);
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file, std::size_t most) {
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, std::strerror(errno));
  std::vector<std::uint8_t> bytes(most + 1);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

RunKey RunKey::read(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) fail(file, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) fail(file, "is not a file");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    fail(file, "others may read it or write to it; type: chmod 600 '" + file.string() + "'");
  }
  const std::vector<std::uint8_t> bytes = bytes_of(file, kMostKeyBytes);
  if (bytes.size() < kLeastKeyBytes || bytes.size() > kMostKeyBytes) {
    fail(file, fmt::format("a key has {} to {} bytes; to make one, type: (umask 77; head -c {} "
                           "/dev/urandom > KEY)",
                           kLeastKeyBytes, kMostKeyBytes, kLeastKeyBytes));
  }
  return RunKey(bytes);
}

RunKey::RunKey(std::span<const std::uint8_t> secret) {
  if (sodium_init() < 0) throw BusError("libsodium cannot be used here");
  static_assert(sizeof key_ >= crypto_generichash_KEYBYTES_MIN &&
                sizeof key_ <= crypto_generichash_KEYBYTES_MAX);
  crypto_generichash(key_.data(), key_.size(), secret.data(), secret.size(), nullptr, 0);
}

RunKey::Signature RunKey::signature_of(std::string_view channel,
                                       std::span<const std::uint8_t> bytes) const {
  static_assert(kSignatureBytes >= crypto_generichash_BYTES_MIN);
  crypto_generichash_state state;
  crypto_generichash_init(&state, key_.data(), key_.size(), kSignatureBytes);
  // With its closing NUL, so that channel and bytes cannot be divided in another way.
  const std::string name(channel);
  crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(name.c_str()),
                            name.size() + 1);
  crypto_generichash_update(&state, bytes.data(), bytes.size());
  Signature signature;
  crypto_generichash_final(&state, signature.data(), signature.size());
  return signature;
}

void RunKey::sign(std::string_view channel, std::vector<std::uint8_t>& bytes) const {
  const Signature signature = signature_of(channel, bytes);
  bytes.insert(bytes.end(), signature.begin(), signature.end());
}

bool RunKey::has_signed(std::string_view channel, std::span<const std::uint8_t> bytes) const {
  if (bytes.size() < kSignatureBytes) return false;
  const auto message = bytes.first(bytes.size() - kSignatureBytes);
  const Signature signature = signature_of(channel, message);
  return sodium_memcmp(signature.data(), bytes.last(kSignatureBytes).data(), kSignatureBytes) == 0;
}

}  // namespace nextview
