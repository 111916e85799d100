#include "viewer/access.h"

#include <gtest/gtest.h>

namespace nextview {
namespace {

TEST(Access, IsByTheNameAndThePortOfThisServerOnly) {
  EXPECT_TRUE(is_own_host("127.0.0.1:7660", 7660));
  EXPECT_TRUE(is_own_host("localhost:7660", 7660));
  for (const char* other : {"", "127.0.0.1", "127.0.0.1:766", "127.0.0.1:76600", "localhost:80",
                            "evil.example:7660", "127.0.0.1.evil.example:7660", "0.0.0.0:7660"}) {
    EXPECT_FALSE(is_own_host(other, 7660)) << other;
  }
}

TEST(Access, OfASocketIsForOwnPagesOnly) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:7660", 7660));
  EXPECT_TRUE(is_own_origin("http://localhost:7660", 7660));
  for (const char* other :
       {"", "null", "127.0.0.1:7660", "https://127.0.0.1:7660", "http://127.0.0.1:7661",
        "http://evil.example", "http://evil.example:7660", "http://localhost:7660.evil.example"}) {
    EXPECT_FALSE(is_own_origin(other, 7660)) << other;
  }
}

}  // namespace
}  // namespace nextview
