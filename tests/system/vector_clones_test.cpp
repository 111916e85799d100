// Loops compiled for each instruction set of this processor give the same bits. Which version of a
// function runs is otherwise chosen when a program starts, and every machine would only ever test
// its own.
#include <gtest/gtest.h>

#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

namespace nextview {
namespace {

std::string output_of(const std::string& instruction_set) {
  const std::string program = NEXTVIEW_VECTOR_CLONES_PROGRAM + instruction_set;
  std::FILE* const pipe = popen(program.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + program);
  std::string output;
  char part[256];
  while (std::fgets(part, sizeof(part), pipe) != nullptr) output += part;
  if (pclose(pipe) != 0) throw std::runtime_error(program + " failed");
  return output;
}

TEST(VectorClones, GiveTheSameBitsOnEveryInstructionSetOfThisProcessor) {
  const std::string expected = output_of("default");
  EXPECT_NE(expected.find("block_numbers"), std::string::npos);
  int compared = 0;
#if defined(__x86_64__) && defined(__linux__)
  if (__builtin_cpu_supports("avx2")) {
    EXPECT_EQ(output_of("avx2"), expected);
    ++compared;
  }
  if (__builtin_cpu_supports("avx512f")) {
    EXPECT_EQ(output_of("avx512f"), expected);
    ++compared;
  }
#endif
  if (compared == 0) GTEST_SKIP() << "this processor has neither AVX2 nor AVX-512: none compared";
  std::cout << compared << " compared with any x86-64's\n";
}

}  // namespace
}  // namespace nextview
