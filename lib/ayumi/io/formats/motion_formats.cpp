#include "ayumi/io/formats/motion_formats.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/animation.hpp"
#include "ayumi/io/formats/body_motion.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/formats/hoap_motion.hpp"
#include "ayumi/io/formats/hrpsys.hpp"
#include "ayumi/io/formats/json_motion.hpp"
#include "ayumi/io/formats/motion_csv.hpp"
#include "ayumi/io/formats/npz_motion.hpp"
#include "ayumi/io/formats/op3_action.hpp"
#include "ayumi/io/formats/pose_sequence.hpp"
#include "ayumi/io/formats/qianim.hpp"
#include "ayumi/io/formats/ros_trajectory.hpp"
#include "ayumi/io/formats/table_motion.hpp"
#include "ayumi/io/formats/transposed_csv.hpp"
#include "ayumi/io/formats/webots_motion.hpp"
#include "ayumi/io/formats/zvs.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

struct Foreign {
  std::string sign;  ///< the bytes that the file begins with
  std::string words, advice;
};

using namespace std::string_literals;

const std::vector<Foreign>& foreign_files() {
  static const std::string arrays =
      "load the file in Python, and save the arrays fps, root_pos, root_rot and dof_pos with "
      "numpy.savez";
  static const std::string retarget =
      "retarget the motion to the robot first, and write the joint angles as CSV";
  static const std::vector<Foreign> files = {
      {"#ROSBAG", "a ROS 1 bag", "write its joint trajectory as YAML, or its joint states as CSV"},
      {"SQLite format 3", "an SQLite database, such as a ROS 2 bag",
       "write its joint states as CSV"},
      {"\x89MCAP", "an MCAP log", "write its joint states as CSV"},
      {"Kaydara FBX Binary", "an FBX scene",
       "retarget the motion to the robot in the program that made the file, and write the joint "
       "angles as CSV"},
      {"; FBX", "an FBX scene",
       "retarget the motion to the robot in the program that made the file, and write the joint "
       "angles as CSV"},
      {"HIERARCHY", "a BVH recording of a person",
       "retarget the motion to the robot first; Ayumi writes BVH files, but does not read them"},
      {"glTF", "a glTF scene", "Ayumi writes glTF files, but does not read them"},
      {"\x57\xE0\xE0\x57\x10\xC0\xC0\x10", "a Havok animation (.hkx)", retarget},
      {"\x1E\x0D\xB0\xCA\xCE\xFA\x11\xD0", "a Havok animation (.hkx)", retarget},
      {"BLENDER", "a scene of Blender", retarget},
      {"NO_OF_FRAMES", "a Qualisys recording of markers (.tsv)", retarget},
      {"%YAML 1.1\n%TAG !u! tag:unity3d.com", "an animation of Unity (.anim)", retarget},
      {"ULog\x01\x12\x35", "a flight log of PX4 (ULog)", "write its joint angles as CSV"},
      {"ARROW1", "a file of Apache Arrow", "write its joint angles as CSV"},
      {"%PDF", "a PDF document", "name the motion file"},
      {"\x80\x02"s, "a Python pickle (.pkl)", arrays},
      {"\x80\x03"s, "a Python pickle (.pkl)", arrays},
      {"\x80\x04"s, "a Python pickle (.pkl)", arrays},
      {"\x80\x05"s, "a Python pickle (.pkl)", arrays},
      {"\x04\x22\x4d\x18", "a file compressed with LZ4, such as one of joblib",
       arrays + "; Ayumi does not read compressed pickles"},
      {"\x1f\x8b", "a file compressed with gzip", "unpack it first"},
      {"\x93NUMPY", "a single NumPy array (.npy)", arrays},
      {"\x89PNG", "a picture", "name the motion file"},
      {"\xFF\xD8\xFF", "a picture", "name the motion file"},
      {"GIF8", "a picture", "name the motion file"},
      {"\x1A\x45\xDF\xA3", "a video", "name the motion file"},
      {"BZh9", "a file compressed with bzip2", "unpack it first"},
      {"\xFD"
       "7zXZ",
       "a file compressed with xz", "unpack it first"},
      {"\x28\xB5\x2F\xFD", "a file compressed with zstd", "unpack it first"},
      {"7z\xBC\xAF", "a 7z archive", "unpack it first"},
      {"x\x9C", "data compressed with zlib, such as a file of joblib", arrays},
      {"x\x01", "data compressed with zlib, such as a file of joblib", arrays},
      {"x\xDA", "data compressed with zlib, such as a file of joblib", arrays},
      {"PAR1", "a Parquet file", "write its joint angles as CSV"},
      {"MATLAB 5.0", "a MATLAB file (.mat)", "write its joint angles as CSV"},
      {"Vocaloid Motion Data", "a motion of MikuMikuDance (.vmd)", retarget},
      {"PathFileType", "a TRC recording of markers", retarget},
      {"#!OML:ASF", "an ASF/AMC recording of a person", retarget},
      {"#VRML", "a VRML scene", "name the motion file"},
      {"ply\n", "a PLY mesh", "name the motion file"},
      {":FULLY-SPECIFIED", "an ASF/AMC recording of a person", retarget},
      {"#usda", "a USD scene", retarget},
      {"PXR-USDC", "a USD scene", retarget},
      {"\x89HDF", "an HDF5 file", "write its joint angles as CSV"}};
  return files;
}

std::string lower_extension(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Number of lines at the beginning that may show the format of a text. Chosen: heads of the formats
// above are shorter.
constexpr size_t kHeadLines = 50;

std::vector<std::string_view> head_lines(const MotionInput& source) {
  std::vector<std::string_view> lines;
  std::string_view rest = source.bytes;
  while (!rest.empty() && lines.size() < kHeadLines)
    if (const std::string_view line = take_line(rest); !line.empty()) lines.push_back(line);
  return lines;
}

// The number of cells of a line that are numbers, and the number of pairs of words with only blanks
// between them.
struct LineParts {
  size_t numbers = 0, cells = 0, word_pairs = 0;
};

LineParts parts_of(std::string_view line) {
  LineParts parts;
  bool word_before = false;
  while (!line.empty()) {
    const size_t end = std::min(line.find_first_of(" \t,;"), line.size());
    const std::string_view cell = line.substr(0, end);
    const bool word = !cell.empty() && std::isalpha(static_cast<unsigned char>(cell.front()));
    parts.cells += !cell.empty();
    parts.numbers += !cell.empty() && cell.find_first_of("0123456789") != std::string_view::npos &&
                     cell.find_first_not_of("0123456789.eE+-") == std::string_view::npos;
    parts.word_pairs += word && word_before;
    if (!cell.empty()) word_before = word;
    if (end < line.size() && line[end] != ' ') word_before = false;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return parts;
}

// Whether a text consists of sentences: it has words between blanks and no row of numbers.
bool is_prose(const MotionInput& source) {
  size_t pairs = 0;
  for (const std::string_view line : head_lines(source)) {
    const LineParts parts = parts_of(line);
    if (parts.numbers >= 2 || (parts.cells > 0 && parts.numbers == parts.cells)) return false;
    pairs += parts.word_pairs;
  }
  return pairs >= 2;
}

bool is_text_stl(const MotionInput& source) {
  const std::vector<std::string_view> lines = head_lines(source);
  return lines.size() > 1 && lines[0].starts_with("solid") &&
         (lines[1].starts_with("facet") || lines[1].starts_with("endsolid"));
}

bool is_asf(const MotionInput& source) {
  for (const std::string_view line : head_lines(source))
    if (line.starts_with(":version") || line.starts_with(":bonedata")) return true;
  return false;
}

// A recording begins with its header, after remarks that begin with `#`.
bool is_htr(const MotionInput& source) {
  const std::vector<std::string_view> lines = head_lines(source);
  const auto first = std::find_if(lines.begin(), lines.end(),
                                  [](std::string_view line) { return line.front() != '#'; });
  return lines.end() - first > 1 && first[0].starts_with("[Header]") &&
         first[1].starts_with("FileType htr");
}

// The kinds of files that their first bytes prove.
const Foreign* signed_kind(const MotionInput& source) {
  for (const Foreign& kind : foreign_files())
    if (source.bytes.starts_with(kind.sign)) return &kind;
  static const Foreign c3d = {
      "", "a C3D recording of markers",
      "retarget the motion to the robot first, and write the joint angles as CSV"};
  if (source.bytes.size() >= 512 && source.bytes[1] == 'P' &&
      static_cast<unsigned char>(source.bytes[0]) < 16)
    return &c3d;
  static const Foreign film = {"", "a video or audio file", "name the motion file"};
  const std::string_view bytes = source.bytes;
  if (bytes.starts_with("RIFF") || (bytes.size() > 8 && bytes.substr(4, 4) == "ftyp")) return &film;
  static const Foreign opensim = {"", "a motion of OpenSim (.mot, .sto)",
                                  "write its coordinates as a table with a head row, as CSV"};
  if (source.bytes.substr(0, 2000).find("\nendheader") != std::string::npos) return &opensim;
  static const Foreign stl = {"", "an STL mesh", "name the motion file"};
  if (is_text_stl(source)) return &stl;
  static const Foreign skeleton = {"", "a skeleton of ASF/AMC",
                                   "retarget the motion to the robot first, and write the joint "
                                   "angles as CSV"};
  if (is_asf(source)) return &skeleton;
  static const Foreign htr = {
      "", "an HTR recording of a person",
      "retarget the motion to the robot first, and write the joint angles as CSV"};
  if (is_htr(source)) return &htr;
  return nullptr;
}

// The kinds of files that their text shows.
const Foreign* text_kind(const MotionInput& source) {
  static const Foreign mtnx = {"", "a motion of ROBOTIS R+ Motion (.mtnx)",
                               "write the motion as CSV, or as an action file (.bin)"};
  static const Foreign pickle = {"", "a Python pickle",
                                 "load the file in Python, and save the arrays fps, root_pos, "
                                 "root_rot and dof_pos with numpy.savez"};
  const std::string extension = lower_extension(source.file);
  if (extension == ".mtnx" || extension == ".mtn") return &mtnx;
  if (source.bytes.substr(0, 2000).find("<Root type=\"Motion\"") != std::string::npos) return &mtnx;
  if (extension == ".pkl" || extension == ".pickle" || extension == ".joblib") return &pickle;
  static const Foreign archive = {
      "", "an archive without the arrays of a motion",
      "save one of these two sets of arrays with numpy.savez: fps, root_pos, root_rot and dof_pos; "
      "or fps, joint_pos, body_pos_w and body_quat_w"};
  static const Foreign workbook = {"", "an Office workbook", "save the sheet as CSV"};
  static const Foreign torch = {"", "a file of PyTorch",
                                "load the file in Python, and save its arrays with numpy.savez"};
  if (source.bytes.starts_with("PK")) {
    // Definition: a ZIP archive ends with a directory; its last record has this signature.
    static const Foreign cut = {"", "the beginning of an archive (.npz) that was cut off",
                                "copy or save it again"};
    if (source.bytes.find("PK\x05\x06") == std::string::npos) return &cut;
    if (source.bytes.find("[Content_Types].xml") != std::string::npos) return &workbook;
    // The arrays of SMPL: rotations of a person's joints and places of the root.
    static const Foreign person = {
        "", "a motion of a person (SMPL, as in AMASS)",
        "retarget the motion to the robot first, and save fps, root_pos, "
        "root_rot and dof_pos with numpy.savez"};
    if (source.bytes.find("poses.npy") != std::string::npos &&
        source.bytes.find("trans.npy") != std::string::npos)
      return &person;
    return source.bytes.find("data.pkl") != std::string::npos ? &torch : &archive;
  }
  static const Foreign urdf = {"", "a robot description (URDF)",
                               "give it with --robot, and name a motion file"};
  static const Foreign mjcf = {"", "a MuJoCo model", "name a motion file"};
  const std::string head = source.bytes.substr(0, 2000);
  if (head.find("<robot") != std::string::npos) return &urdf;
  if (head.find("<mujoco") != std::string::npos) return &mjcf;
  static const Foreign xsens = {
      "", "a recording of Xsens (.mvnx)",
      "retarget the motion to the robot first, and write the joint angles as CSV"};
  static const Foreign collada = {"", "a COLLADA scene",
                                  "retarget the motion to the robot first, and write the joint "
                                  "angles as CSV"};
  if (head.find("<mvnx") != std::string::npos) return &xsens;
  if (head.find("<COLLADA") != std::string::npos) return &collada;
  static const Foreign gltf = {"", "a glTF scene",
                               "Ayumi writes glTF files, but does not read them"};
  if (head.starts_with("{") && head.find("\"asset\"") != std::string::npos &&
      source.bytes.find("\"nodes\"") != std::string::npos)
    return &gltf;
  static const Foreign xml = {"", "an XML file of a kind that Ayumi does not know",
                              "write the motion in one of these formats"};
  if (head.starts_with("<")) return &xml;
  return nullptr;
}

}  // namespace

const std::vector<MotionFormat>& motion_formats() {
  static const std::vector<MotionFormat> formats = {
      {"tracking-npz", "tracking .npz", kJointNames | kRate | kRoot, false, true,
       recognize_tracking_npz, read_tracking_npz, write_tracking_npz},
      {"gmr-npz", "GMR .npz", kJointNames | kRate | kRoot, false, true, recognize_gmr_npz,
       read_gmr_npz, write_gmr_npz},
      {"op3-action", "ROBOTIS OP3 action file", kRate, true, true, recognize_op3_action,
       read_op3_action, write_op3_action},
      {"webots", "Webots .motion", kJointNames | kRate, false, false, recognize_webots_motion,
       read_webots_motion, write_webots_motion},
      {"webots-1.1", "Webots .motion V1.1 with durations", kJointNames | kRate, false, false,
       recognize_webots_durations, read_webots_motion, write_webots_durations},
      {"choreonoid", "Choreonoid BodyMotion",
       kJointNames | kRate | kRoot | kZmp | kCog | kVerticalForce, false, false,
       recognize_body_motion, read_body_motion, write_body_motion},
      {"choreonoid-poses", "Choreonoid key poses (.pseq)", kRate | kRoot | kZmp, false, false,
       recognize_pose_sequence, nullptr, nullptr, read_pose_sequence},
      {"ros-trajectory", "ROS JointTrajectory", kJointNames | kRate, true, false,
       recognize_ros_trajectory, read_ros_trajectory, write_ros_trajectory},
      {"play-motion2", "play_motion2 parameters", kJointNames | kRate, true, false,
       recognize_play_motion, read_play_motion, write_play_motion},
      {"qianim", "NAO animation curves", kJointNames | kRate, true, false, recognize_qianim,
       read_qianim, write_qianim},
      {"poppy-move", "Poppy .move", kJointNames | kRate, true, false, recognize_poppy_move,
       read_poppy_move, write_poppy_move},
      {"open-duck", "Open Duck reference motion", kJointNames | kRate | kRoot, false, false,
       recognize_open_duck, read_open_duck, write_open_duck},
      {"deepmimic", "DeepMimic frames", kJointNames | kRate | kRoot, false, false,
       recognize_deep_mimic, read_deep_mimic, write_deep_mimic},
      {"zvs", "mi-lib .zvs", kRate | kRoot, false, false, recognize_zvs, read_zvs, write_zvs},
      {"transposed-csv", "CSV with a row for each joint", kJointNames | kRate, false, false,
       recognize_transposed_csv, read_transposed_csv, write_transposed_csv},
      {"motion-csv", "motion CSV without a head row", kRoot, false, false, recognize_motion_csv,
       read_motion_csv, write_motion_csv},
      {"hoap", "HOAP sequence", kRate, true, false, recognize_hoap_motion, read_hoap_motion,
       nullptr},
      {"hrpsys", "hrpsys .pos", kRate | kRoot | kZmp | kTorque, true, false, recognize_hrpsys,
       read_hrpsys, write_hrpsys},
      {"json", "joint table as JSON", ~0u, true, false, recognize_json_table, read_json_table,
       nullptr},
      {"csv", "table with a head row", ~0u, true, false, recognize_csv_table, read_csv_table,
       nullptr},
      {"bvh", "BVH", kJointNames | kRate | kRoot, false, false, nullptr, nullptr, write_bvh},
      {"mujoco-keys", "MuJoCo keyframes", kRate | kRoot, false, false, nullptr, nullptr,
       write_mujoco_keys}};
  return formats;
}

const MotionFormat* find_motion_format(const std::string& name) {
  for (const MotionFormat& format : motion_formats())
    if (format.name == name) return &format;
  return nullptr;
}

std::vector<std::string> read_format_names() {
  std::vector<std::string> names;
  for (const MotionFormat& format : motion_formats())
    if (format.read || format.read_keys) names.push_back(format.name);
  return names;
}

std::vector<std::string> written_format_names() {
  std::vector<std::string> names;
  for (const MotionFormat& format : motion_formats())
    if (format.write) names.push_back(format.name);
  return names;
}

Recognized recognize(const MotionInput& source) {
  const Foreign* kind = signed_kind(source);
  // Number of bytes that are examined. Chosen: no text has bytes of 0 at its beginning, whatever
  // else stands there.
  constexpr size_t kBeginning = 100;
  const bool binary = source.bytes.substr(0, kBeginning).find('\0') != std::string::npos;
  for (const MotionFormat& format : motion_formats()) {
    if (kind) break;
    if (!format.recognize || (binary && !format.binary)) continue;
    const std::string reason = format.recognize(source);
    if (reason.empty()) continue;
    static const Foreign prose = {"", "a text without rows of numbers", "name the motion file"};
    if (format.name == "csv" && is_prose(source)) {
      kind = &prose;
      break;
    }
    return {&format, reason};
  }
  const std::string formats = "import reads " + text::join(read_format_names(), ", ");
  if (source.bytes.find_first_not_of(" \t\r\n") == std::string::npos)
    source.refuse(0, "the file is empty");
  if (!kind) kind = text_kind(source);
  if (kind)
    source.refuse(0, "this is " + kind->words + ", which import does not read; " + kind->advice +
                         " (" + formats + ")");
  source.refuse(
      0, std::string(binary ? "this is a binary file in a format" : "this is a file in a format") +
             " that import does not know; " + formats);
}

std::string cannot_hold(const MotionFormat& format, const MotionFile& motion) {
  std::vector<std::string> lost;
  const auto say = [&](unsigned part, bool present, const char* words) {
    if (present && !(format.holds & part)) lost.emplace_back(words);
  };
  say(kJointNames, !motion.joints.empty(), "the names of the joints");
  say(kRate, true, "the rate");
  say(kRoot, !motion.base.empty(), "the track of the root");
  say(kZmp, !motion.zmp.empty(), "the ZMP");
  say(kCog, !motion.cog.empty(), "the COG");
  say(kVerticalForce, !motion.fz.empty(), "the vertical force");
  say(kTorque, motion.torque.size() > 0, "the torques");
  say(kContacts, !motion.support.empty(), "the contacts");
  return text::join(lost, ", ");
}

}  // namespace ayumi
