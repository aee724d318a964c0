// Writes the seeds of every fuzz target and its dictionary: `ayumi_fuzz_seeds FOLDER` makes
// FOLDER/<target>/ and FOLDER/<target>.dict. Everything is made from the robots, patterns and
// schemas of the project.

#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "ayumi/base/file.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/mesh_message.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "fuzz_target.hpp"
#include "requests_seed.hpp"

namespace {

namespace fs = std::filesystem;
using namespace ayumi;
using Json = nlohmann::ordered_json;

const fs::path kSources = AYUMI_SOURCE_DIR;

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}
  void put(const std::string& target, const std::string& name, const std::string& bytes) const {
    fs::create_directories(folder_ / target);
    write_file(folder_ / target / name, bytes);
  }
  void put(const std::string& target, const std::string& name,
           const std::vector<fuzz::Part>& parts) const {
    put(target, name, fuzz::joined(parts));
  }
  /// The words of a schema: keys, and the strings of enumerations.
  void dictionary(const std::string& target, const std::set<std::string>& words) const {
    std::string text;
    for (const std::string& word : words) {
      text += '"';
      for (const unsigned char c : word) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped,
                      c < 32 || c > 126 || c == '"' || c == '\\' ? "\\x%02X" : "%c", c);
        text += escaped;
      }
      text += "\"\n";
    }
    write_file(folder_ / (target + ".dict"), text);
  }

 private:
  fs::path folder_;
};

void collect_words(const Json& node, std::set<std::string>& words) {
  if (node.is_object()) {
    if (node.contains("properties") && node["properties"].is_object())
      for (const auto& [key, value] : node["properties"].items()) words.insert("\"" + key + "\"");
    for (const char* key : {"enum", "const", "default", "examples"})
      if (node.contains(key)) {
        const Json& values = node[key].is_array() ? node[key] : Json::array({node[key]});
        for (const Json& value : values)
          if (value.is_string()) words.insert("\"" + value.get<std::string>() + "\"");
      }
    for (const auto& [key, value] : node.items()) collect_words(value, words);
  } else if (node.is_array()) {
    for (const Json& value : node) collect_words(value, words);
  }
}

std::set<std::string> words_of_schemas(const std::vector<std::string>& names) {
  std::set<std::string> words;
  for (const std::string& name : names)
    collect_words(Json::parse(read_file(kSources / "docs/schemas" / (name + "-1.schema.json"))),
                  words);
  return words;
}

/// The names of elements and attributes of an XML text.
std::set<std::string> words_of_xml(const std::string& text) {
  std::set<std::string> words;
  for (size_t at = 0; at < text.size(); ++at)
    if (text[at] == '<' || text[at] == ' ') {
      const size_t end = text.find_first_of(" =/><\n\"", at + 1);
      if (end != std::string::npos && end > at + 1)
        words.insert(text.substr(at, end - at + (text[end] == '=')));
    }
  return words;
}

/// The keys of a JSON text.
void collect_keys(const Json& node, std::set<std::string>& words) {
  if (node.is_object())
    for (const auto& [key, value] : node.items()) words.insert("\"" + key + "\"");
  if (node.is_structured())
    for (const Json& value : node) collect_keys(value, words);
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == extension) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

MotionFile short_motion(const RobotModel& model) {
  MotionFile motion;
  motion.rate = 50;
  motion.joints = model.dof_names();
  motion.values.resize(6, model.dof_count());
  for (int k = 0; k < 6; ++k) {
    motion.times.push_back(k / motion.rate);
    for (int j = 0; j < model.dof_count(); ++j) motion.values(k, j) = 0.02 * k * (j % 3);
    BasePose base;
    base.position = {0.01 * k, 0, 0.25};
    base.attitude = Eigen::Quaterniond(std::cos(0.01 * k), 0, 0, std::sin(0.01 * k));
    motion.base.push_back(base);
    motion.zmp.emplace_back(0.01 * k, 0.001 * k, 0);
  }
  return motion;
}

const char* const kLibrary = R"({"format": "ayumi.postures/1", "units": {"angle": "deg"},
"postures": {"bent": {"l_knee": 40, "r_knee": 40}, "arms": {"l_shoulder_pitch": 20}}})";

const char* const kIncluding =
    R"json({"format": "ayumi.pattern/1", "name": "fuzz", "robot": "hoap1",
"units": {"angle": "deg"}, "parameters": {"a": 2, "stride": 0.04}, "include": "postures.json",
"defaults": {"interpolation": "cubic", "posture": "home", "cog_height": 0.24},
"start": {"left": [0, 0.039], "right": [0.01, -0.039, 0, 5]},
"phases": [{"until": 0.8, "support": "both"},
{"until": 1.25, "support": "left", "swing": {"foot": "right", "to": ["${stride}", -0.039], "lift": 0.01}},
{"until": 3, "support": "both"}],
"keyframes": [{"t": 0, "zmp": "center"}, {"t": 0.8, "zmp": "left", "interpolation": "linear"},
{"t": 1.5, "posture": "bent", "torso": {"pitch": "${a}*sin(pi/6)"
}
},
{"t": 2.4, "zmp": ["(${stride} + 0.02)/2", 0], "cog": {"height": 0.235}, "fz": 60},
{"t": 3, "posture": "home", "joints": {"l_knee": 60}}],
"world": {"friction": 0.7, "ground": {"pitch": 2}}, "controller": {"type": "dtad", "gains": {"q": 0.25}},
"scenario": [{"type": "impulse", "at": 1.55, "duration": 0.02, "on": "cog", "direction": [0, -2, 0], "impulse": 1.1}],
"tolerances": {
  "foot_slip" : 0.002
}
})json";

void pattern_seeds(const Seeds& seeds) {
  DenseTable table;
  table.joints = fuzz::hoap1().dof_names();
  table.theta = Eigen::MatrixXd::Zero(11, fuzz::hoap1().dof_count());
  const std::string csv = dense_table_csv(table);
  seeds.put("pattern", "including", {{"", kIncluding}, {"postures.json", kLibrary}});
  seeds.put("pattern", "library", std::string(kLibrary));
  seeds.put("pattern", "table",
            {{"", R"({"format": "ayumi.pattern/1", "robot": "hoap1", "table": "table.csv",
"phases": [{"until": 0.01, "support": "both"}]})"},
             {"table.csv", csv}});
  seeds.put("table", "dense", csv);
  for (const char* folder : {"patterns", "examples"})
    for (const fs::path& file : files_in(kSources / folder, ".json")) {
      const std::string text = read_file(file);
      if (text.find("ayumi.pattern/1") != std::string::npos)
        seeds.put("pattern", file.stem().string(), text);
      if (text.find("ayumi.study/1") != std::string::npos)
        seeds.put("results", file.stem().string(), text);
    }
  seeds.dictionary("pattern", words_of_schemas({"pattern", "postures"}));
  const char* const expressions[] = {"${stride}*2 + 0.01*sin(pi/6)",
                                     "-(1 + 2)/3",
                                     "atan2(1, -2)",
                                     "min(1, max(2, abs(-3)))",
                                     "sqrt(2)*cos(pi)",
                                     "1e-3",
                                     "${a} - ${zero}"};
  int number = 0;
  for (const char* text : expressions)
    seeds.put("expression", std::to_string(number++), std::string(text));
  seeds.dictionary("expression", {"${a}", "${stride}", "${zero}", "sin(", "cos(", "sqrt(", "abs(",
                                  "atan2(", "min(", "max(", "pi", "e-3", "((((", "))))"});
}

void robot_seeds(const Seeds& seeds) {
  std::set<std::string> words;
  for (const char* folder : {"robots", "examples"})
    for (const fs::path& file : files_in(kSources / folder, ".urdf")) {
      const std::string text = read_file(file), name = file.parent_path().filename().string();
      words.merge(words_of_xml(text));
      seeds.put("urdf", name, text);
      const fs::path sidecar = file.parent_path() / "robot.json";
      if (fs::exists(sidecar))
        seeds.put("sidecar", name, {{"", read_file(sidecar)}, {"robot.urdf", text}});
    }
  seeds.put("urdf", "small", std::string(R"(<robot name="r"><link name="a"><inertial>
<origin xyz="0 0 0.1" rpy="0 0 0"/><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
<link name="b"><inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
</inertial><collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.2"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="3" velocity="5"/>
<dynamics damping="0.1" friction="0.1"/><mimic joint="k" multiplier="2"/></joint></robot>)"));
  seeds.put("sidecar", "based",
            std::string(R"({"format": "ayumi.robot/1", "base": "hoap1", "name": "other"})"));
  seeds.dictionary("urdf", words);
  seeds.dictionary("sidecar", words_of_schemas({"robot"}));
  for (const fs::path& file : files_in(kSources / "robots", ".json"))
    if (file.filename() == "uncertainty.json")
      seeds.put("results", file.parent_path().filename().string(), read_file(file));
}

void motion_seeds(const Seeds& seeds) {
  std::set<std::string> words;
  for (const std::string& joint : fuzz::hoap1().dof_names()) words.insert(joint);
  for (const MotionFormat& format : motion_formats()) {
    words.insert(format.name + "\n");
    if (!format.write) continue;
    std::vector<fuzz::Part> parts;
    MotionFile motion = short_motion(fuzz::hoap1());
    if (format.name == "op3-action") motion.rate = 62.5;
    for (const WrittenFile& file : format.write(fuzz::hoap1(), motion))
      parts.push_back({parts.empty() ? "" : "motion" + file.extension, file.bytes});
    const std::string bytes = fuzz::joined(parts);
    seeds.put("motion", format.name, format.name + "\n" + bytes);
    seeds.put("motion", format.name + "-seen", "\n" + bytes);
  }
  seeds.dictionary("motion", words);
}

const char* const kPush =
    R"({"format": "ayumi.push/1", "study": {"controllers": [{"type": "none"}, {"type": "dtad"}]},
"cases": [{"phase": "single support left", "at_s": 1.5, "direction_rad": 0.5, "bound_Ns": 0.9,
"open_loop": {"impulse_Ns": 0.2}, "limits": [{"impulse_Ns": 0.2, "capped": false}, {"impulse_Ns": 1.1, "capped": true}]}]
})";

void run_seeds(const Seeds& seeds) {
  const RobotModel& model = fuzz::hoap1();
  const Pattern pattern = pattern_of_text(R"({"format": "ayumi.pattern/1", "robot": "hoap1",
"phases": [{"until": 0.02, "support": "both"}], "keyframes": [{"t": 0}, {"t": 0.02}]})",
                                          kSources / "fuzz.json");
  SimulateOptions options;
  options.settle = 0;
  const SimulationLog log = simulate(model, sample(model, pattern), options);
  seeds.put("log", "plain", plain_log_bytes(log));
  seeds.put("log", "compressed", log_bytes(log));
  RunFolder run;
  run.provenance = log.provenance;
  run.logs = {{"closed_loop", log}};
  run.reference = extract_reference(model, log);
  seeds.put("table", "reference", reference_csv(*run.reference));
  seeds.put("table", "reference_json", reference_json(*run.reference));
  run.sections = {
      {"check", R"({"verdict": "consistent", "profile": "hoap1", "findings": [], "summary": {}})"},
      {"repair", R"({"status": "repaired", "moved": {"joints": [], "cog": {"max_m": 0}},
"iterations": 3, "reasons": []})"},
      {"export",
       R"({"safe": true, "max_step_ratio": 0.5, "worst_joint": "l_knee", "violations": []})"}};
  // The run is written into a folder of its own, and then as one input. (A log may contain any
  // byte, so that it stays outside.)
  const fuzz::InputFolder folder({{"", ""}}, "none");
  const fs::path place = folder.path("run");
  fs::remove_all(place);
  write_run(place, run);
  Json json = Json::parse(read_file(place / "run.json"));
  seeds.put("run", "whole",
            {{"", json.dump(2)}, {"reference.csv", read_file(place / "reference.csv")}});
  json["logs"] = Json::object();
  json["files"].erase("log_closed_loop.bin");
  seeds.put("run", "without_logs",
            {{"", json.dump(2)}, {"reference.csv", read_file(place / "reference.csv")}});
  fs::remove_all(place);
  std::set<std::string> words;
  collect_keys(json, words);
  seeds.dictionary("run", words);
  words.clear();
  collect_keys(Json::parse(kPush), words);
  words.merge(words_of_schemas({"study"}));
  seeds.dictionary("results", words);
  seeds.put("results", "push", std::string(kPush));
  seeds.dictionary("table", {"t[s]", "theta.", "[rad]", "cog.x[m]", "zmp.x[m]", "fz[N]", "base.qw",
                             "contact.left", "# dt: ", "# theta: commands", "# format: "});
  seeds.dictionary("log",
                   {"\"rows\":", "\"columns\":", "\"joints\":", "\"scenario\":", "AYUMILOG"});
}

void mesh_seeds(const Seeds& seeds) {
  TriangleMesh mesh;
  MeshPart part;
  part.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  part.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  part.uvs = {{0, 0}, {1, 0}, {0, 1}};
  part.triangles = {{0, 1, 2}};
  part.texture_file = std::string(1, kTextureName) + "picture.jpg";
  mesh.parts = {part, part};
  mesh.parts[1].uvs.clear();
  mesh.parts[1].texture_file.clear();
  mesh.parts[1].has_color = true;
  seeds.put("mesh_answer", "two_parts", encode_mesh(mesh));
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1 2 3\nf 1/1 3 4\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string stl =
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
  const std::string dae =
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
 version="1.4.1"><asset><unit name="meter" meter="1"/></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX"
 source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})";
  seeds.put("mesh_file", "obj", "mesh.obj\n" + obj);
  seeds.put("mesh_file", "ply", "mesh.ply\n" + ply);
  seeds.put("mesh_file", "stl", "mesh.stl\n" + stl);
  seeds.put("mesh_file", "dae", "mesh.dae\n" + dae);
  seeds.put("mesh_file", "gltf", "mesh.gltf\n" + gltf);
  seeds.put("collada", "dae", dae);
  std::set<std::string> words = words_of_xml(dae);
  seeds.dictionary("collada", words);
  words.merge(std::set<std::string>{"element vertex ", "property list uchar int ", "facet normal ",
                                    "\"byteLength\":"});
  seeds.dictionary("mesh_file", words);
  seeds.dictionary("mesh_answer", {std::string(8, '\0'), std::string(8, '\xff')});
}

void request_seeds(const Seeds& seeds) {
  const std::string host = "Host: 127.0.0.1:" + std::to_string(fuzz::kPort) + "\n";
  const std::string hash = "\"hash\": \"" + sha256(fuzz::kAuthored) + "\"";
  const auto head = [&](const std::string& method, const std::string& path) {
    return method + " /" + fuzz::kSecret + "/" + path + " HTTP/1.1\n" + host;
  };
  for (const std::string path :
       {"", "state", "model.glb", "scenery", "series?which=plan", "events"})
    seeds.put("requests", "get_" + path.substr(0, path.find('?')), head("GET", path));
  seeds.put("requests", "cancel", head("DELETE", "job/1"));
  const std::pair<std::string, std::string> posts[] = {
      {"edit",
       "{" + hash + R"(, "edits": [{"kind": "set", "pointer": "/keyframes/1/t", "value": 0.09},
{"kind": "insert", "pointer": "/keyframes/2", "value": {"t": 0.1, "zmp": "left"}},
{"kind": "remove", "pointer": "/name"}]})"},
      {"edit", "{" + hash + R"(, "text": "{\"format\": \"ayumi.pattern/1\"}"})"},
      {"undo", "{" + hash + "}"},
      {"redo", "{" + hash + "}"},
      {"pose", R"({"time": 0.05, "joints": {"l_elbow": -0.2}})"},
      {"pose", R"({"time": 0.1, "drag": "cog", "to": [0.01, 0, 0.24]})"},
      {"pose", R"({"time": 0.1, "drag": "left foot", "target": "pose", "to": [0.01, 0.04, 0.02]})"},
      {"posture", R"({"time": 0.1, "name": "bent", "mirror": true})"},
      {"mirror", R"({"pointer": "/keyframes/1"})"},
      {"job", R"({"kind": "simulate", "options": {}})"},
      {"job", R"({"kind": "repair"})"}};
  std::set<std::string> words = words_of_schemas({"pattern"});
  int number = 0;
  for (const auto& [path, body] : posts) {
    const std::string origin = number % 2 ? "Origin: http://127.0.0.1:8080\n" : "";
    seeds.put(
        "requests", path + std::to_string(number++),
        {{"", head("POST", path) + origin +
                  "Content-Type: application/json\nContent-Length: " + fuzz::kLengthOfBody + "\n"},
         {"body", body}});
    collect_keys(Json::parse(body), words);
  }
  words.merge(
      std::set<std::string>{"Host: ", "Origin: ", "Content-Length: ", "Expect: 100-continue",
                            "Transfer-Encoding: chunked", "Content-Encoding: gzip",
                            "Range: bytes=0-1", "Connection: close", "multipart/form-data",
                            "application/x-www-form-urlencoded", "HEAD ", "PUT ", "OPTIONS "});
  seeds.dictionary("requests", words);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: ayumi_fuzz_seeds FOLDER\n";
    return 2;
  }
  const Seeds seeds(argv[1]);
  pattern_seeds(seeds);
  robot_seeds(seeds);
  motion_seeds(seeds);
  run_seeds(seeds);
  mesh_seeds(seeds);
  request_seeds(seeds);
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
