#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>

namespace nextview {

using FuzzInput = std::span<const std::uint8_t>;

/// What must hold whatever the input: libFuzzer keeps the input when it does not.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::cerr << "does not hold: " << what << std::endl;
  std::abort();
}

/// A file of a process's own, in memory where there is such a folder, that holds the input.
class FuzzFile {
 public:
  explicit FuzzFile(const std::string& name) {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    folder_ = folder / ("nextview-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    file_ = folder_ / name;
  }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;
  ~FuzzFile() {
    std::error_code none;
    std::filesystem::remove_all(folder_, none);
  }

  const std::filesystem::path& hold(FuzzInput input) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(input.data()),
               static_cast<std::streamsize>(input.size()));
    return file_;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
};

}  // namespace nextview
