// CAD files that hang assimp or make it abort, and the user's patience with them.
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <chrono>
#include <filesystem>

#include "lcmtypes/bus.h"
#include "runner/port_lock.h"
#include "runner/run_setup.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

const std::filesystem::path kData =
    std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests" / "scene" / "data";
const std::string kEndless = (kData / "endless.ply").string();

/// Waits until the program reads a CAD file.
/// @param meanwhile  done again and again
template <class Work>
pid_t reader_of(Program& program, const Work& meanwhile) {
  pid_t reader = 0;
  for (int i = 0; i < 10000 && reader == 0; ++i) {
    meanwhile();
    reader = program.child("cad_reader");
  }
  return reader;
}
pid_t reader_of(Program& program) {
  return reader_of(program, [] { ::poll(nullptr, 0, 1); });
}

class Interrupted : public testing::TestWithParam<int> {};

TEST_P(Interrupted, ARunThatReadsForEverEndsAtOnce) {
  for (const char* name : {"nextview_run", "nextview_bound"}) {
    Program program({program_path(name), kEndless, "--start", "1", "1", "1"});
    const pid_t reader = reader_of(program);
    ASSERT_NE(reader, 0) << program.output();
    program.signal(GetParam());
    EXPECT_EQ(program.wait(), 128) << "by the signal";
    wait_until_gone(reader);
  }
}

INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(BadCadFile, IsGivenUpByASimulatorThatIsToEnd) {
  const PortLock port = PortLock::acquire();
  Bus bus(port.lcm_url(), 7, "run");
  RunOptions options;
  options.scenes_folder = NEXTVIEW_SOURCE_DIR "/scenes";
  run_config_t config = prepare_run(options).config;
  config.run = 7;
  config.scene_file = kEndless;
  bus.publish(config);
  for (const int number : {SIGINT, SIGTERM}) {
    for (const char* name : {"nextview_sensor_sim", "nextview_base_sim"}) {
      Program simulator({program_path(name), "--lcm-url=" + port.lcm_url(), "--run=7"});
      const pid_t reader =
          reader_of(simulator, [&bus] { bus.handle(std::chrono::milliseconds(5)); });
      ASSERT_NE(reader, 0) << simulator.output();
      simulator.signal(number);
      EXPECT_EQ(simulator.wait(), 0) << simulator.output();
      EXPECT_EQ(simulator.output(), "");
      wait_until_gone(reader);
    }
  }
}

TEST(BadCadFile, ThatTakesForEverIsGivenUp) {
  const Outcome outcome =
      run_program({"/usr/bin/env", "NEXTVIEW_CAD_SECONDS=1", program_path("nextview_run"), kEndless,
                   "--start", "1", "1", "1"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("endless.ply: reading it took longer than 1 s"), std::string::npos)
      << outcome.output;
}

TEST(BadCadFile, ThatMakesAssimpAbortEndsNobody) {
  for (const char* name : {"nextview_run", "nextview_bound"}) {
    const Outcome outcome =
        run_program({program_path(name), (kData / "abort.off").string(), "--start", "1", "1", "1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find("abort.off: reading it crashed"), std::string::npos)
        << outcome.output;
  }
}

// Killed, nobody can end the reader any more: it must end by itself.
TEST(BadCadFile, IsReadNoLongerThanSomebodyWaitsForIt) {
  Program run({program_path("nextview_run"), kEndless, "--start", "1", "1", "1"});
  const pid_t reader = reader_of(run);
  ASSERT_NE(reader, 0);
  run.signal(SIGKILL);
  run.wait();
  wait_until_gone(reader);
}

}  // namespace
}  // namespace nextview
