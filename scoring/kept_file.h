#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace nextview {

/// Under what a result is kept on disk: a digest of everything it depends on. Two keys are the same
/// where the same things have been added in the same order.
class KeptKey {
 public:
  /// @param kind what is kept, in lower case
  /// @param version another one for every change in how the result is worked out or written
  KeptKey(std::string_view kind, int version);
  ~KeptKey();
  KeptKey(const KeptKey&) = delete;
  KeptKey& operator=(const KeptKey&) = delete;

  void add(std::string_view text);
  void add(double value);

  /// The kind, and 32 hexadecimal digits: fit for the name of a file.
  std::string text() const;

 private:
  struct Hash;
  std::string kind_;
  std::unique_ptr<Hash> hash_;
};

/// Where results are kept: what is given, else NEXTVIEW_CACHE, else XDG_CACHE_HOME/nextview, else
/// ~/.cache/nextview; empty when none of them is known.
std::string cache_folder(const std::string& given);

/// What is kept in a folder under a key; nothing when there is nothing, or when it is damaged.
std::optional<std::string> read_kept(const std::string& folder, const std::string& key);

/// Keeps bytes under a key, in place of what was there: a reader finds all of them or none. Makes
/// the folder.
/// @return false when that cannot be done
bool keep(const std::string& folder, const std::string& key, std::string_view bytes);

}  // namespace nextview
