// Answers about meshes that were read before: never wrong, whatever has changed or is broken.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/io/robot/mesh_reader_place.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

class CachedMeshes : public testing::Test {
 protected:
  // A triangle with its corner at x, with a material from a file beside it.
  fs::path triangle(double x) const {
    return folder_.write("t.obj", "mtllib t.mtl\nusemtl red\nv " + std::to_string(x) +
                                      " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  void material(const std::string& color) const {
    folder_.write("t.mtl", "newmtl red\nKd " + color + "\n");
  }
  TriangleMesh read(const fs::path& path, double scale = 1) const {
    MeshReading reading;
    reading.cache = cache();
    return load_mesh(path, Eigen::Vector3d::Constant(scale), reading);
  }
  static double corner(const TriangleMesh& mesh) { return mesh.parts.at(0).vertices.at(0).x(); }
  static float red(const TriangleMesh& mesh) { return mesh.parts.at(0).color[0]; }
  fs::path cache() const { return folder_.path() / "cache"; }
  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    if (fs::exists(cache()))
      for (const auto& entry : fs::directory_iterator(cache())) found.push_back(entry.path());
    return found;
  }

  TemporaryFolder folder_;
};

TEST_F(CachedMeshes, AreReadWithoutTheReader) {
  material("1 0 0");
  const auto path = triangle(0.5);
  // A reader that notes each of its starts.
  const fs::path starts = folder_.write("starts", "");
  const fs::path program =
      folder_.write("reader", "#!/bin/sh\necho . >> " + starts.string() + "\nexec " +
                                  find_mesh_reader().string() + "\n");
  fs::permissions(program, fs::perms::owner_all);
  for (int i = 0; i < 3; ++i) {
    const TriangleMesh mesh =
        load_mesh(path, Eigen::Vector3d::Ones(), {.program = program, .cache = cache()});
    EXPECT_EQ(corner(mesh), 0.5);
    EXPECT_EQ(red(mesh), 1);
    EXPECT_EQ(read_file(starts), ".\n") << i;
  }
  // The answer of another reader may be another one.
  read(path);
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(CachedMeshes, AreNeverThoseOfAnotherFile) {
  material("1 0 0");
  EXPECT_EQ(corner(read(triangle(0.5))), 0.5);
  EXPECT_EQ(corner(read(triangle(0.25))), 0.25) << "other bytes under the same name";
  EXPECT_EQ(corner(read(triangle(0.5))), 0.5);
  EXPECT_EQ(corner(read(triangle(0.5), 2)), 1) << "another scale";
  EXPECT_EQ(entries().size(), 3u);
  material("0 1 0");
  EXPECT_EQ(red(read(triangle(0.5))), 0) << "another material in the file beside it";
  fs::remove(folder_.path() / "t.mtl");
  EXPECT_FALSE(read(triangle(0.5)).parts.at(0).color == Eigen::Vector4f(0, 1, 0, 1));
  material("1 0 0");
  EXPECT_EQ(red(read(triangle(0.5))), 1) << "a file that was missing";
}

// One byte is changed, or the end is missing: the mesh is read again, and the entry is good again.
TEST_F(CachedMeshes, ThatAreBrokenAreReadAgain) {
  material("1 0 0");
  const auto path = triangle(0.5);
  read(path);
  ASSERT_EQ(entries().size(), 1u);
  const fs::path entry = entries().front();
  const std::string good = read_file(entry);
  for (size_t at = 0; at < good.size(); at += 7) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    std::ofstream(entry, std::ios::binary) << bad;
    if (at % 5 == 0) {
      EXPECT_EQ(corner(read(path)), 0.5) << at;
    }
    std::ofstream(entry, std::ios::binary) << good.substr(0, at);
    if (at % 5 == 1) {
      EXPECT_EQ(corner(read(path)), 0.5) << at;
    }
  }
  std::ofstream(entry, std::ios::binary) << good + "more";
  EXPECT_EQ(corner(read(path)), 0.5);
  EXPECT_EQ(read_file(entry), good);
}

TEST_F(CachedMeshes, MayHaveNoPlace) {
  material("1 0 0");
  const auto path = triangle(0.5);
  folder_.write("cache", "a file and no folder");
  EXPECT_EQ(corner(read(path)), 0.5);
  EXPECT_EQ(read_file(cache()), "a file and no folder");
  fs::remove(cache());
  fs::create_directory(cache());
  fs::permissions(cache(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(corner(read(path)), 0.5);
  MeshReading without;
  without.cache.reset();
  EXPECT_EQ(corner(load_mesh(path, Eigen::Vector3d::Ones(), without)), 0.5);
}

TEST_F(CachedMeshes, TakeABoundedSpace) {
  fs::create_directories(cache() / "a folder");
  fs::create_symlink("nowhere", cache() / "a link");
  // Files without bytes on the disk: the oldest are deleted until the rest has room.
  for (int i = 0; i < 5; ++i) {
    const fs::path old = cache() / ("old" + std::to_string(i));
    std::ofstream(old).put('x');
    fs::resize_file(old, MeshCache::kMostBytes / 3);
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(10 - i));
  }
  // The space is counted again after each 16 MiB.
  const MeshCache meshes(cache());
  meshes.keep("new", {}, std::string(size_t{17} << 20, 'x'));
  std::uintmax_t all = 0;
  for (const fs::path& entry : entries())
    if (fs::is_regular_file(entry)) all += fs::file_size(entry);
  EXPECT_LE(all, MeshCache::kMostBytes);
  EXPECT_FALSE(fs::exists(cache() / "old2"));
  EXPECT_TRUE(fs::exists(cache() / "old4"));
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  EXPECT_TRUE(meshes.find("new", none));
  meshes.keep("large", {}, std::string(MeshCache::kLargestAnswer + 1, 'x'));
  EXPECT_FALSE(meshes.find("large", none));
}

}  // namespace
}  // namespace ayumi
