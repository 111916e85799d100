#include "scene/cad_answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

namespace nextview {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File empty_file() { return {std::tmpfile(), std::fclose}; }

TriangleMesh two_triangles() {
  TriangleMesh mesh;
  mesh.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  return mesh;
}

std::string bytes_of(std::FILE* file) {
  std::fseek(file, 0, SEEK_END);
  std::string bytes(static_cast<std::size_t>(std::ftell(file)), '\0');
  std::rewind(file);
  EXPECT_EQ(std::fread(bytes.data(), 1, bytes.size(), file), bytes.size());
  return bytes;
}

std::optional<CadAnswer> answer_in(const std::string& bytes) {
  const File file = empty_file();
  std::fwrite(bytes.data(), 1, bytes.size(), file.get());
  return take_answer(file.get());
}

TEST(CadAnswer, IsTheMeshThatWasWritten) {
  const File file = empty_file();
  ASSERT_TRUE(write_answer(file.get(), two_triangles()));
  const std::optional<CadAnswer> answer = take_answer(file.get());
  ASSERT_TRUE(answer && answer->mesh);
  EXPECT_EQ(answer->mesh->vertices_m, two_triangles().vertices_m);
  EXPECT_EQ(answer->mesh->triangles, two_triangles().triangles);
  EXPECT_EQ(answer->why_not, "");
}

TEST(CadAnswer, IsWhyThereIsNone) {
  const File file = empty_file();
  ASSERT_TRUE(write_answer(file.get(), std::string("room.obj: no such file")));
  const std::optional<CadAnswer> answer = take_answer(file.get());
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->mesh);
  EXPECT_EQ(answer->why_not, "room.obj: no such file");
}

TEST(CadAnswer, IsNoneWhenItIsNotWhole) {
  const File mesh = empty_file();
  ASSERT_TRUE(write_answer(mesh.get(), two_triangles()));
  const File words = empty_file();
  ASSERT_TRUE(write_answer(words.get(), std::string("no such file")));
  for (const std::string& bytes : {bytes_of(mesh.get()), bytes_of(words.get())}) {
    EXPECT_TRUE(answer_in(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(answer_in(bytes.substr(0, size))) << size;
    }
  }
}

TEST(CadAnswer, IsNoneWhenItsSizesCannotBe) {
  const File file = empty_file();
  ASSERT_TRUE(write_answer(file.get(), two_triangles()));
  const std::string bytes = bytes_of(file.get());
  for (std::size_t at = 0; at < 24; ++at) {  // the heading
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ '\x7f');
    EXPECT_FALSE(answer_in(changed)) << at;
  }
}

TEST(CadAnswer, IsNoneWhenAMeshIsNotSound) {
  TriangleMesh beyond = two_triangles();
  beyond.triangles[1][2] = 4;
  TriangleMesh not_finite = two_triangles();
  not_finite.vertices_m[3].y() = NAN;
  for (const TriangleMesh& mesh : {beyond, not_finite}) {
    const File file = empty_file();
    ASSERT_TRUE(write_answer(file.get(), mesh));
    EXPECT_FALSE(take_answer(file.get()));
  }
}

}  // namespace
}  // namespace nextview
