// Meshes are read in a separate process: hostile files, readers that fail, and answers that must
// not be believed.

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>

#include "ayumi/base/child_process.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/io/robot/mesh_message.hpp"
#include "ayumi/io/robot/mesh_reader_place.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::error_message;
using test::TemporaryFolder;

const char* const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A tetrahedron. `accessor` has the attributes of the accessor of its places, `nodes` is a library
/// of nodes, and `node` is the content of the node of the scene.
std::string collada(const std::string& accessor, const std::string& nodes,
                    const std::string& node) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="12">
0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common>
<accessor source="#pa" count="4" )" +
         accessor + R"(><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles></mesh></geometry></library_geometries>)" +
         nodes + R"(<library_visual_scenes><visual_scene id="s"><node id="n">)" + node +
         R"(</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const char* const kInstance = "<instance_geometry url=\"#g\"/>";

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// A file with 4^20 instances of one geometry.
std::string bomb() {
  std::string nodes = "<library_nodes>";
  for (int i = 0; i < 20; ++i)
    nodes += "<node id=\"a" + std::to_string(i) + "\">" +
             repeated("<instance_node url=\"#a" + std::to_string(i + 1) + "\"/>", 4) + "</node>";
  return nodes + "<node id=\"a20\">" + kInstance + "</node></library_nodes>";
}

std::string ply(const std::string& format, const std::string& vertices) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n0 0 0\n";
}

std::string glb(char version) {
  const char bytes[] = {'g', 'l',    'T',    'F',    version, 0,   0,   0,   22,  0,   0,
                        0,   '\xf0', '\xff', '\xff', '\xff',  'J', 'S', 'O', 'N', '{', '}'};
  return std::string(bytes, sizeof bytes);
}

struct Hostile {
  std::string file, bytes;
  std::string message;  ///< one of the parts between bars must be in the message
};
std::ostream& operator<<(std::ostream& out, const Hostile& hostile) { return out << hostile.file; }

class HostileMesh : public testing::TestWithParam<Hostile> {};

// The reader process holds the memory, so that the memory of this process does not grow. The test
// therefore shows that this process lives, answers soon and gives one message.
TEST_P(HostileMesh, IsRefusedInOneLine) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers reserve terabytes of addresses, so the reader has no limit";
#endif
  const TemporaryFolder folder;
  const auto path = folder.write(GetParam().file, GetParam().bytes);
  const auto begin = std::chrono::steady_clock::now();
  const std::string message = error_message([&] { load_mesh(path); }, ErrorCode::bad_file);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  bool found = false;
  std::istringstream parts(GetParam().message);
  for (std::string part; std::getline(parts, part, '|');)
    found = found || message.find(part) != std::string::npos;
  EXPECT_TRUE(found) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Files, HostileMesh,
    testing::Values(
        Hostile{"far_offset.dae", collada("stride=\"3\" offset=\"100000\"", "", kInstance),
                "'100000' is not a valid count or index"},
        Hostile{"near_offset.dae", collada("stride=\"3\" offset=\"1\"", "", kInstance),
                "an accessor reaches number 13 of '#pa', which has 12"},
        Hostile{"single_quotes.dae", collada("stride='3' offset='9'", "", kInstance),
                "an accessor reaches number 21 of '#pa', which has 12"},
        Hostile{"stride.dae", collada("stride=\"5\"", "", kInstance),
                "an accessor reaches number 18 of '#pa', which has 12"},
        Hostile{"negative_offset.dae", collada("stride=\"3\" offset=\"-5\"", "", kInstance),
                "'-5' is not a valid count or index"},
        Hostile{"cycle.dae",
                collada("stride=\"3\"",
                        "<library_nodes><node id=\"a\"><instance_node url=\"#b\"/></node>"
                        "<node id=\"b\"><instance_node url=\"#a\"/></node></library_nodes>",
                        "<instance_node url=\"#a\"/>"),
                "the program that reads meshes crashed on this file|more memory"},
        Hostile{"deep.dae",
                collada("stride=\"3\"", "",
                        repeated("<node>", 200000) + kInstance + repeated("</node>", 200000)),
                "the program that reads meshes crashed on this file|more memory"},
        Hostile{"bomb.dae", collada("stride=\"3\"", bomb(), "<instance_node url=\"#a0\"/>"),
                "more memory than the 256 MiB|crashed"},
        Hostile{"tiny_1.glb", glb(1), "more memory than the 256 MiB|cannot be read|crashed"},
        Hostile{"tiny_2.glb", glb(2), "more memory than the 256 MiB|cannot be read|crashed"},
        Hostile{"binary.ply", ply("binary_little_endian", "4000000000"),
                "more memory than the 256 MiB|cannot be read|crashed"},
        Hostile{"ascii.ply", ply("ascii", "60000000"),
                "more memory than the 256 MiB|cannot be read|crashed"},
        Hostile{"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 300000000\n", "out of range"},
        Hostile{"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a vertex is not finite"},
        Hostile{"empty.obj", "", "the mesh file is empty"},
        Hostile{"words.stl", "no mesh at all", "cannot be read as a mesh"}),
    [](const auto& info) {
      std::string name = info.param.file;
      std::replace(name.begin(), name.end(), '.', '_');
      return name;
    });

TEST(HostileMesh, HidesNoneOfTheOthers) {
  const TemporaryFolder folder;
  const auto good = folder.write("good.obj", kTriangle);
  const auto deep = folder.write(
      "deep.dae", collada("stride=\"3\"", "",
                          repeated("<node>", 200000) + kInstance + repeated("</node>", 200000)));
  const auto words = folder.write("words.stl", "no mesh at all");
  MeshFailure failure;
  // One reader reads the good mesh and the deep one; after it has crashed, a fresh one reads the
  // last.
  EXPECT_EQ(load_meshes({{good}, {good}, {good}, {good}, {good}, {good}}, failure).size(), 6u);
  EXPECT_FALSE(failure.error);
  load_meshes({{good}, {good}, {words}, {good}, {good}, {deep}}, failure);
  EXPECT_EQ(failure.request, 2u);
  load_meshes({{good}, {deep}, {good}, {good}, {good}, {good}, {words}}, failure);
  EXPECT_EQ(failure.request, 1u) << "the first in the order of the requests";
  EXPECT_NE(error_message([&] { std::rethrow_exception(failure.error); }).find("deep.dae"),
            std::string::npos);
}

// In an earlier version, a stop had an effect only after all meshes had been read, which took
// seconds.
TEST(MeshReader, IsStoppedWhileItReads) {
  const TemporaryFolder folder;
  const auto mesh = folder.write("good.obj", kTriangle);
  const auto slow = folder.write("slow", "#!/bin/sh\nexec /bin/sleep 30\n");
  std::filesystem::permissions(slow, std::filesystem::perms::owner_all);
  MeshFailure failure;
  int heard = 0;
  const auto stop = [&](const ProgressEvent&) { return ++heard < 3; };
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(load_meshes({{mesh}, {mesh}}, failure, {.program = slow}, stop), Interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(MeshCompanions, AreOpenedOnlyWhereTheyMayBelongToAMesh) {
  const TemporaryFolder folder;
  const std::string material = "newmtl red\nKd 1 0 0\n";
  folder.write("colours.mtl", material);
  folder.write("colours.txt", material);
  const auto is_red = [&](const std::string& library) {
    const auto path =
        folder.write("t.obj", "mtllib " + library + "\nusemtl red\n" + std::string(kTriangle));
    return load_mesh(path).parts.at(0).color == Eigen::Vector4f(1, 0, 0, 1);
  };
  EXPECT_TRUE(is_red("colours.mtl"));
  EXPECT_FALSE(is_red("colours.txt")) << "the name of another kind of file";
  EXPECT_FALSE(is_red((folder.path() / "colours.mtl").string())) << "an absolute path";
  EXPECT_FALSE(is_red("/etc/passwd"));
}

// A reader that is a shell script; its connection is its standard input.
class FailingMeshReader : public testing::Test {
 protected:
  // A hello, with kind 0x4d595901 and version 1, least byte first.
  const std::string hello =
      "printf '\\001\\131\\131\\115\\000\\000\\000\\000\\001\\000\\000\\000\\000\\000\\000\\000' "
      ">&0\n";

  std::string message(const std::string& script, MeshReading reading = {}) {
    reading.program = folder_.write("reader", "#!/bin/sh\n" + script);
    std::filesystem::permissions(reading.program, std::filesystem::perms::owner_all);
    mesh_ = folder_.write("t.obj", kTriangle);
    return error_message([&] { load_mesh(mesh_, Eigen::Vector3d::Ones(), reading); },
                         ErrorCode::bad_file);
  }
  // The head of a message of this kind with a size, both as octal bytes for printf, least byte
  // first.
  static std::string head(const std::string& kind, const std::string& size) {
    return "printf '" + kind + "\\131\\131\\115\\000\\000\\000\\000" + size + "' >&0\n";
  }

  TemporaryFolder folder_;
  std::filesystem::path mesh_;
};

TEST_F(FailingMeshReader, EndsBeforeItBegins) {
  const std::string text = message("exit 7\n");
  EXPECT_NE(
      text.find(
          "reader: this program, which reads meshes, ended before it was ready (exit code 7)"),
      std::string::npos)
      << text;
}

TEST_F(FailingMeshReader, IsAnotherProgram) {
  const std::string text = message("printf 'Hello, I am not the reader of meshes' >&0\n");
  EXPECT_NE(text.find("this program, which reads meshes, belongs to another version of Ayumi"),
            std::string::npos)
      << text;
}

TEST_F(FailingMeshReader, Crashes) {
  const std::string text = message(hello + "kill -SEGV $$\n");
  EXPECT_NE(text.find("t.obj: the program that reads meshes crashed on this file (signal 11"),
            std::string::npos)
      << text;
}

TEST_F(FailingMeshReader, NeverAnswers) {
  MeshReading reading;
  reading.time = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  const std::string text = message(hello + "exec /bin/sleep 60\n", reading);
  EXPECT_NE(text.find("t.obj: reading this mesh takes longer than 0.3 s"), std::string::npos)
      << text;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20)) << "it is killed";
}

TEST_F(FailingMeshReader, AnswersWithTooMuch) {
  const std::string mesh = "\\005", huge = "\\000\\000\\000\\000\\377\\377\\000\\000";
  const std::string text = message(hello + head(mesh, huge) + "exec /bin/sleep 60\n");
  EXPECT_NE(text.find("but at most 1073741824 bytes are accepted"), std::string::npos) << text;
}

TEST_F(FailingMeshReader, AnswersWithNonsense) {
  const std::string mesh = "\\005", eight = "\\010\\000\\000\\000\\000\\000\\000\\000";
  const std::string text =
      message(hello + head(mesh, eight) +
              "printf '\\377\\377\\377\\377\\377\\000\\000\\000' >&0\n" + "exec /bin/sleep 60\n");
  EXPECT_NE(text.find("t.obj: the answer of the program that reads meshes is not valid (part 0: "
                      "more parts than "
                      "bytes)"),
            std::string::npos)
      << text;
}

TEST_F(FailingMeshReader, RefusesWithWordsThatSteerATerminal) {
  const std::string refusal = "\\006", four = "\\004\\000\\000\\000\\000\\000\\000\\000";
  const std::string text =
      message(hello + head(refusal, four) + "printf 'a\\033[b' >&0\nexec /bin/sleep 60\n");
  EXPECT_TRUE(text.ends_with("t.obj: a?[b")) << text;
}

TEST_F(FailingMeshReader, CannotBeStarted) {
  MeshReading reading;
  reading.program = folder_.path() / "missing";
  const auto path = folder_.write("t.obj", kTriangle);
  const std::string text =
      error_message([&] { load_mesh(path, Eigen::Vector3d::Ones(), reading); });
  EXPECT_NE(text.find("missing: the program cannot be started (No such file or directory)"),
            std::string::npos)
      << text;
}

// The numbers of a process in /proc/PID/status and /proc/PID/limits.
std::string line_of_process(const std::string& process, const std::string& file,
                            const std::string& name) {
  std::ifstream lines("/proc/" + process + "/" + file);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name)) return line.substr(name.size());
  return "no such line";
}

TEST(MeshReaderProcess, IsConfined) {
  ChildProcess child(find_mesh_reader(), {});
  child.set_time(20);
  MeshMessageHead hello;  // the process is confined when it says so
  ASSERT_EQ(child.receive(&hello, sizeof hello), ChildProcess::Exchange::done);
  std::ifstream children("/proc/thread-self/children");
  std::string process;
  if (!(children >> process)) GTEST_SKIP() << "this kernel does not list children";
  EXPECT_EQ(line_of_process(process, "status", "NoNewPrivs:"), "\t1");
  const std::string files = line_of_process(process, "limits", "Max file size");
  EXPECT_EQ(files.substr(0, files.find_last_not_of(" bytes") + 1).find_first_not_of(" 0"),
            std::string::npos)
      << files;
#if defined(AYUMI_HAS_SECCOMP) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_EQ(line_of_process(process, "status", "Seccomp:"), "\t2") << "filtered system calls";
#endif
  std::istringstream environment(line_of_process(process, "environ", ""));
  EXPECT_EQ(environment.str().find("HOME="), std::string::npos);
}

TriangleMesh square() {
  MeshPart part;
  part.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  part.normals.assign(4, Eigen::Vector3f::UnitZ());
  part.uvs.assign(4, Eigen::Vector2f(0.5f, 0.25f));
  part.triangles = {{0, 1, 2}, {0, 2, 3}};
  part.has_color = true;
  part.color = {0.1f, 0.2f, 0.3f, 0.4f};
  part.texture_file = "nsquare.png";
  TriangleMesh mesh;
  mesh.parts = {part, part};
  return mesh;
}

TEST(EncodedMesh, ComesBackAsItWas) {
  const std::string bytes = encode_mesh(square());
  const TriangleMesh back = decode_mesh(bytes);
  EXPECT_EQ(encode_mesh(back), bytes);
  ASSERT_EQ(back.parts.size(), 2u);
  const MeshPart& part = back.parts[1];
  EXPECT_EQ(part.vertices, square().parts[1].vertices);
  EXPECT_EQ(part.triangles, square().parts[1].triangles);
  EXPECT_EQ(part.color, square().parts[1].color);
  EXPECT_EQ(part.texture_file, "nsquare.png");
}

TEST(EncodedMesh, IsNotBelieved) {
  const auto complaint = [](const std::function<void(MeshPart&)>& change) {
    TriangleMesh mesh = square();
    change(mesh.parts[1]);
    return error_message([&] { decode_mesh(encode_mesh(mesh)); }, ErrorCode::bad_file);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(complaint([](MeshPart& part) { part.triangles[1][2] = 4; }),
            "part 1: triangle 1 names vertex 4 of 4");
  EXPECT_EQ(complaint([&](MeshPart& part) { part.vertices[2].y() = nan; }),
            "part 1: vertex 2 is not finite");
  EXPECT_EQ(complaint([&](MeshPart& part) { part.normals[3].x() = nan; }),
            "part 1: normal 3 is not a unit vector");
  EXPECT_EQ(complaint([](MeshPart& part) { part.normals[0] *= 2; }),
            "part 1: normal 0 is not a unit vector");
  EXPECT_EQ(complaint([&](MeshPart& part) { part.uvs[0].x() = nan; }),
            "part 1: a texture coordinate is not finite");
  EXPECT_EQ(complaint([](MeshPart& part) { part.uvs.pop_back(); }),
            "part 1: 3 texture coordinates for 4 vertices");
  EXPECT_EQ(complaint([](MeshPart& part) { part.triangles.clear(); }), "part 1: no triangle");
  EXPECT_EQ(complaint([&](MeshPart& part) { part.color[3] = nan; }),
            "part 1: the colour is not finite");
  EXPECT_EQ(complaint([](MeshPart& part) { part.texture_file = "square.png"; }),
            "part 1: the texture is neither a name nor a picture");
}

// Whatever value a single byte gets, the decoder either refuses the mesh or returns a correct one.
TEST(EncodedMesh, MayHaveAnyByteChanged) {
  const std::string bytes = encode_mesh(square());
  int refused = 0;
  for (size_t at = 0; at < bytes.size(); ++at)
    for (const int value : {0, 1, 127, 255}) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(value);
      try {
        const TriangleMesh mesh = decode_mesh(changed);
        for (const MeshPart& part : mesh.parts)
          for (const auto& triangle : part.triangles)
            for (const std::uint32_t corner : triangle) ASSERT_LT(corner, part.vertices.size());
      } catch (const Error&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 100);
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(error_message([&] { decode_mesh(std::string_view(bytes).substr(0, size)); }),
              "no error");
  EXPECT_NE(error_message([&] { decode_mesh(bytes + "x"); }), "no error");
}

}  // namespace
}  // namespace ayumi
