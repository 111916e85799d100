// A sensor's file, as --sensor takes it.
#include "sensor/sensor_catalog.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static FuzzFile file("sensor.json");
  try {
    (void)find_sensor(file.hold(FuzzInput(bytes, size)).string(), file.folder(), {});
  } catch (const SensorError&) {
    // Said to the user.
  }
  return 0;
}
