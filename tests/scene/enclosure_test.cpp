#include "scene/enclosure.h"

#include <gtest/gtest.h>

#include "scene/mesh_file.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

TEST(EscapeShare, NoneInAClosedRoomAndWhatTheCeilingTookUpWithoutIt) {
  TriangleMesh mesh = load_mesh(kDataFolder / "room.obj");
  EXPECT_EQ(escape_share(Scene(mesh), {0, 0, 1}), 0.0);
  // Without a ceiling, seen from a corner of the ceiling's plane, the upper half escapes.
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return mesh.vertices_m[triangle[0]].z() == 2.0F && mesh.vertices_m[triangle[1]].z() == 2.0F &&
           mesh.vertices_m[triangle[2]].z() == 2.0F;
  });
  ASSERT_EQ(mesh.triangles.size(), 10U);
  EXPECT_NEAR(escape_share(Scene(mesh), {0, 0, 1.9999}), 0.5, 0.001);
}

TEST(VisibleVolume, IsTheRoomsAndEndsAtTheBounds) {
  TriangleMesh mesh = load_mesh(kDataFolder / "room.obj");
  EXPECT_NEAR(visible_volume_m3(Scene(mesh), {0, 0, 1}), 24.0, 0.3);
  mesh.triangles.pop_back();  // half a wall
  EXPECT_NEAR(visible_volume_m3(Scene(mesh), {0, 0, 1}), 24.0, 0.3);
}

}  // namespace
}  // namespace nextview
