#include "lcmtypes/run_key.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "lcmtypes/bus.h"
#include "lcmtypes/signed_transport.h"
#include "tests/lcmtypes/examples.h"
#include "tests/lcmtypes/lossy_network.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// A file of a key, removed with the test.
class KeyFile {
 public:
  explicit KeyFile(const std::string& secret, fs::perms permissions = fs::perms::owner_read)
      : path_(fs::path(testing::TempDir()) /
              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
               std::to_string(++number_) + ".key")) {
    fs::remove(path_);
    std::ofstream(path_, std::ios::binary) << secret;
    fs::permissions(path_, permissions);
  }
  ~KeyFile() { fs::remove(path_); }
  const fs::path& path() const { return path_; }

 private:
  static inline int number_ = 0;
  fs::path path_;
};

RunKey key_of(const std::string& secret) { return RunKey::read(KeyFile(secret).path()); }

const std::string kSecret(32, 'a');
const std::string kOther(32, 'b');

std::string refusal_of(const fs::path& file) {
  try {
    RunKey::read(file);
  } catch (const BusError& error) {
    return error.what();
  }
  return {};
}

TEST(RunKey, KnowsWhatItHasSignedAndNothingElse) {
  const RunKey key = key_of(kSecret);
  std::vector<std::uint8_t> bytes = {1, 2, 3, 4, 5};
  key.sign("GOAL", bytes);
  ASSERT_EQ(bytes.size(), 5 + RunKey::kSignatureBytes);
  EXPECT_TRUE(key.has_signed("GOAL", bytes));
  EXPECT_TRUE(key_of(kSecret).has_signed("GOAL", bytes)) << "as everybody with this key sees";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      bytes[i] ^= static_cast<std::uint8_t>(1 << bit);
      EXPECT_FALSE(key.has_signed("GOAL", bytes)) << i << ", " << bit;
      bytes[i] ^= static_cast<std::uint8_t>(1 << bit);
    }
  }
  EXPECT_FALSE(key.has_signed("GOALS", bytes)) << "on another channel";
  EXPECT_FALSE(key.has_signed("", bytes));
  EXPECT_FALSE(key_of(kOther).has_signed("GOAL", bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(key.has_signed("GOAL", std::span(bytes).first(size))) << size;
  }
}

TEST(RunKey, SignsTheSameMessageAlike) {
  std::vector<std::uint8_t> once = {7};
  std::vector<std::uint8_t> again = once;
  key_of(kSecret).sign("A", once);
  key_of(kSecret).sign("A", again);
  EXPECT_EQ(once, again);
}

TEST(RunKey, TellsABoundaryBetweenChannelAndMessage) {
  const RunKey key = key_of(kSecret);
  std::vector<std::uint8_t> one = {'B', 'C'};
  std::vector<std::uint8_t> other = {'C'};
  key.sign("A", one);
  key.sign("AB", other);
  EXPECT_FALSE(std::ranges::equal(std::span(one).last(16), std::span(other).last(16)));
}

TEST(RunKey, SaysWhatIsWrongWithAFile) {
  EXPECT_NE(refusal_of("/no/such/key").find("--key-file /no/such/key: No such file"),
            std::string::npos);
  EXPECT_NE(refusal_of(testing::TempDir()).find("is not a file"), std::string::npos);
  EXPECT_NE(refusal_of(KeyFile("short").path()).find("head -c 32 /dev/urandom"), std::string::npos);
  EXPECT_NE(refusal_of(KeyFile("").path()).find("a key has 32 to 4096 bytes"), std::string::npos);
  EXPECT_NE(refusal_of(KeyFile(std::string(4097, 'a')).path()).find("a key has 32 to 4096 bytes"),
            std::string::npos);
  EXPECT_EQ(refusal_of(KeyFile(std::string(4096, 'a')).path()), "");
  const KeyFile open(kSecret, fs::perms::owner_read | fs::perms::others_read);
  EXPECT_NE(refusal_of(open.path()).find("chmod 600"), std::string::npos);
}

// What LCM's own programs do with a message: lcm-spy and a logger of one's own still read it.
TEST(RunKey, LeavesAMessageToBeDecodedByWhoeverHasNoKey) {
  goal_t goal = example<goal_t>();
  goal.view = 12;
  std::vector<std::uint8_t> bytes = encode(goal);
  key_of(kSecret).sign(Channel<goal_t>::name, bytes);
  goal_t decoded;
  EXPECT_GT(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  EXPECT_EQ(decoded.view, 12);
}

// Members of one run on one network, with keys or without.
class SignedBus : public testing::Test {
 protected:
  std::unique_ptr<Transport> with(const std::string& secret) {
    return std::make_unique<SignedTransport>(network_.connect(), key_of(secret));
  }
  static int views_heard(Bus& mapper, std::initializer_list<Bus*> others) {
    int views = 0;
    mapper.on<goal_t>([&views](const goal_t& goal) { views += goal.view; });
    for (Bus* other : others) {
      goal_t goal = example<goal_t>();
      goal.view = 1;
      other->publish(goal);
    }
    while (mapper.handle(milliseconds(0))) {
    }
    mapper.handle(milliseconds(0));
    return views;
  }
  LossyNetwork network_{{}};
};

TEST_F(SignedBus, HearsItsOwnAndRefusesOthers) {
  Bus mapper(with(kSecret), 7, "mapper");
  Bus planner(with(kSecret), 7, "planner");
  Bus without_key(network_.connect(), 7, "forger");
  Bus of_another(with(kOther), 7, "stranger");
  EXPECT_EQ(views_heard(mapper, {&without_key, &of_another, &planner}), 1);
  EXPECT_EQ(mapper.counters().refused, 2);
  EXPECT_EQ(mapper.counters().repeated, 0) << "a forger does not take the place of the true one";
}

TEST_F(SignedBus, IsNotUnderstoodWithoutTheKey) {
  Bus mapper(network_.connect(), 7, "mapper");
  Bus planner(with(kSecret), 7, "planner");
  EXPECT_EQ(views_heard(mapper, {&planner}), 0);
  EXPECT_GE(mapper.counters().refused, 1);
}

TEST_F(SignedBus, RefusesWhatWasSaidOnAnotherChannelAndTakesWhatIsRepeatedOnce) {
  Bus mapper(with(kSecret), 7, "mapper");
  Bus planner(with(kSecret), 7, "planner");
  goal_t goal = example<goal_t>();
  goal.view = 1;
  planner.publish(goal);
  const auto sent = network_.published().back().second;
  const auto stranger = network_.connect();
  stranger->publish(Channel<arrival_t>::name, sent);
  stranger->publish(Channel<goal_t>::name, sent);
  int goals = 0;
  int arrivals = 0;
  mapper.on<goal_t>([&goals](const goal_t&) { ++goals; });
  mapper.on<arrival_t>([&arrivals](const arrival_t&) { ++arrivals; });
  while (mapper.handle(milliseconds(0))) {
  }
  mapper.handle(milliseconds(0));
  EXPECT_EQ(goals, 1);
  EXPECT_EQ(arrivals, 0);
  EXPECT_EQ(mapper.counters().repeated, 1);
  EXPECT_EQ(mapper.counters().refused, 1);
}

}  // namespace
}  // namespace nextview
