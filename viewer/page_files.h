#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace nextview {

/// A file of the page as it is served.
struct PageFile {
  std::string type;  ///< of its content
  std::string content;
};

/// The files of the page by their paths, "/" among them. All are read here, so that no request can
/// name any other. Where the page has not been built, one that says how to.
std::map<std::string, PageFile, std::less<>> page_files(const std::filesystem::path& folder);

}  // namespace nextview
