#include "viewer/page_files.h"

#include <fstream>
#include <iterator>

namespace nextview {
namespace {

std::string type_of(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  return "text/plain; charset=utf-8";
}

}  // namespace

std::map<std::string, PageFile, std::less<>> page_files(const std::filesystem::path& folder) {
  std::map<std::string, PageFile, std::less<>> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::string path = "/";
    path += std::filesystem::relative(entry.path(), folder).generic_string();
    files[path] = {type_of(entry.path()), {std::istreambuf_iterator<char>(in), {}}};
  }
  const auto index = files.find("/index.html");
  files["/"] = index != files.end()
                   ? index->second
                   : PageFile{type_of("x.html"),
                              "<!doctype html><title>nextview</title><p>The page has not been "
                              "built. In the folder of nextview type <code>./view</code> instead, "
                              "which builds it."};
  return files;
}

}  // namespace nextview
