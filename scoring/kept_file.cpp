#include "scoring/kept_file.h"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

namespace nextview {
namespace {

namespace fs = std::filesystem;

std::string hex(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// Before the bytes: that it is ours, under which key, and what the bytes are.
std::string heading_of(const std::string& key, std::string_view bytes) {
  return "nextview keeps " + key + " " + hex(XXH3_128bits(bytes.data(), bytes.size())) + "\n";
}

}  // namespace

struct KeptKey::Hash {
  XXH3_state_t* state = XXH3_createState();
  Hash() {
    if (state == nullptr || XXH3_128bits_reset(state) != XXH_OK) throw std::bad_alloc();
  }
  ~Hash() { XXH3_freeState(state); }
};

KeptKey::KeptKey(std::string_view kind, int version)
    : kind_(kind), hash_(std::make_unique<Hash>()) {
  std::replace(kind_.begin(), kind_.end(), ' ', '-');
  add(kind);
  add(static_cast<double>(version));
}

KeptKey::~KeptKey() = default;

void KeptKey::add(std::string_view text) {
  add(static_cast<double>(text.size()));
  XXH3_128bits_update(hash_->state, text.data(), text.size());
}

void KeptKey::add(double value) {
  const double same_zero = value + 0.0;  // -0 is 0
  XXH3_128bits_update(hash_->state, &same_zero, sizeof same_zero);
}

std::string KeptKey::text() const { return kind_ + "-" + hex(XXH3_128bits_digest(hash_->state)); }

std::string cache_folder(const std::string& given) {
  if (!given.empty()) return given;
  const auto environment = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (std::string own = environment("NEXTVIEW_CACHE"); !own.empty()) return own;
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) return xdg + "/nextview";
  if (const std::string home = environment("HOME"); !home.empty()) return home + "/.cache/nextview";
  return {};
}

std::optional<std::string> read_kept(const std::string& folder, const std::string& key) {
  std::ifstream in(fs::path(folder) / key, std::ios::binary);
  std::string heading;
  if (!std::getline(in, heading)) return std::nullopt;
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad() || heading + "\n" != heading_of(key, bytes)) return std::nullopt;
  return bytes;
}

bool keep(const std::string& folder, const std::string& key, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(folder, error);
  // Written beside it and then given its name, which is done at once.
  const fs::path file = fs::path(folder) / key;
  const fs::path written = file.string() + "." + std::to_string(::getpid()) + ".part";
  std::ofstream out(written, std::ios::binary);
  out << heading_of(key, bytes) << bytes;
  out.close();
  if (out) fs::rename(written, file, error);
  if (!out || error) {
    std::error_code nothing_to_remove;
    fs::remove(written, nothing_to_remove);
    return false;
  }
  return true;
}

}  // namespace nextview
