// A scene file, as ./run FILE.toml takes it.
#include <array>
#include <string>

#include "runner/run_options.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static FuzzFile file("scene.toml");
  std::string program = "nextview_run";
  std::string scene = file.hold(FuzzInput(bytes, size)).string();
  std::array<char*, 3> arguments = {program.data(), scene.data(), nullptr};
  int exit_status = -1;
  const auto options = parse_run_options(2, arguments.data(), exit_status, "");
  demand(options.has_value() || exit_status >= 0, "options, or an exit status");
  return 0;
}
