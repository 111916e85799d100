// The command line of ./run, its arguments a line each.
#include <string>
#include <vector>

#include "runner/run_options.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  std::vector<std::string> words = {"nextview_run", ""};
  for (const std::uint8_t byte : FuzzInput(bytes, size)) {
    if (byte == '\n') {
      words.emplace_back();
    } else if (byte != 0) {  // where an argument ends
      words.back() += static_cast<char>(byte);
    }
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int exit_status = -1;
  const auto options =
      parse_run_options(static_cast<int>(words.size()), arguments.data(), exit_status, "");
  demand(options.has_value() || exit_status >= 0, "options, or an exit status");
  return 0;
}
