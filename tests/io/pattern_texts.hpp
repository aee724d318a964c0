#pragma once
// Patterns as text, correct and broken, and a folder to read them from.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "tests/support/degree.hpp"

namespace ayumi::test {

namespace fs = std::filesystem;

class PatternFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        ("ayumi_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Pattern read(const std::string& text, const std::map<std::string, double>& set = {}) const {
    return read_pattern(put("p.json", text), set);
  }
  std::string message(const std::string& text,
                      const std::map<std::string, double>& set = {}) const {
    try {
      read(text, set);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  fs::path folder_;
};

inline const char* const kTwoSteps = R"({
  // comments are welcome
  "format": "ayumi.pattern/1",
  "name": "two steps forward, pushed from the left",
  "robot": "hoap1",
  "units": { "angle": "deg" },
  "parameters": { "stride": 0.04 },
  "defaults": { "interpolation": "cubic", "posture": "home", "cog_height": 0.24, "cog_model": "point_mass" },
  "start": { "left": [0, 0.039], "right": [0.01, -0.039, 0, 5] },
  "phases": [
    { "until": 0.80, "support": "both" },
    { "until": 1.25, "support": "left", "swing": { "foot": "right", "to": ["${stride}", -0.039], "lift": 0.01 } },
    { "until": 3.00, "support": "both" }
  ],
  "keyframes": [
    { "t": 0, "zmp": "center" },
    { "t": 0.80, "zmp": "left", "interpolation": "linear" },
    { "t": 1.50, "posture": { "l_shoulder_pitch": 70 }, "torso": { "pitch": 3 } },
    { "t": 2.40, "zmp": ["(${stride} + 0.02)/2", 0], "cog": { "height": 0.235 }, "fz": 60 },
    { "t": 3.00, "posture": "home", "joints": { "l_knee": 90 }, "weights": { "l_knee": 2 },
      "feet": { "left": { "position": [0, 0.04, 0.01], "rpy": [0, -10, 0] } } }
  ],
  "world": { "friction": 0.7, "ground": { "pitch": 2 } },
  "controller": { "type": "dtad", "gains": { "q": 0.25 } },
  "scenario": [
    { "type": "impulse", "at": 1.55, "duration": 0.020, "on": "cog", "direction": [0, -2, 0], "impulse": 1.1 }
  ],
  "tolerances": { "foot_slip": 0.002 }
})";

// A small pattern with one piece replaced.
inline std::string with(const std::string& key, const std::string& value) {
  const std::map<std::string, std::string> parts = {
      {"format", "\"ayumi.pattern/1\""},
      {"robot", "\"hoap1\""},
      {"units", R"({"angle": "deg"})"},
      {"phases", R"([{"until": 1, "support": "both"}])"},
      {"keyframes", R"([{"t": 0, "posture": "home"}])"}};
  std::string text = "{\n";
  for (const auto& [name, standard] : parts) {
    const std::string& piece = name == key ? value : standard;
    if (!piece.empty()) text += "\"" + name + "\": " + piece + ",\n";
  }
  if (!parts.contains(key)) text += "\"" + key + "\": " + value + ",\n";
  text.erase(text.size() - 2);
  return text + "}\n";
}

struct Broken {
  const char *key, *value, *message;
};

inline const std::vector<Broken>& mistakes() {
  static const std::vector<Broken> cases = {
      {"format", "\"ayumi.pattern/2\"", "/format: 'ayumi.pattern/2' cannot be read"},
      {"format", "", "the key 'format' is missing"},
      {"robot", "", "the key 'robot' is missing"},
      {"robot", "\"\"", "/robot: the name is empty"},
      {"robot", "3", "/robot: expected a string, found the number 3"},
      {"phases", "", "the key 'phases' is missing"},
      {"phases", "[]", "/phases: the list is empty"},
      {"phases", "{}", "/phases: expected an array"},
      {"keyframes", "", "the key 'keyframes' is missing"},
      {"keyframes", "[]", "/keyframes: the list is empty"},
      {"keyframes", "[3]", "/keyframes/0: expected an object"},
      {"keyframe", "[]", "/keyframe: unknown key; did you mean 'keyframes'?"},
      {"phases", R"([{"until": 1, "suport": "both"}])",
       "/phases/0/suport: unknown key; did you mean"},
      {"phases", R"([{"until": 1, "support": "bth"}])",
       "/phases/0/support: 'bth' is not allowed; the allowed values are"},
      {"phases", R"([{"until": 1, "support": "both", "viip": {"cog": [0,0,0]}}])",
       "/phases/0/support: a phase with \"viip\" has neither support"},
      {"phases", R"([{"until": 1, "viip": {}}])", "/phases/0/viip: expected one goal"},
      {"phases", R"([{"until": 1, "viip": {"cog": [0,0,0], "steps": 3}}])", "expected one goal"},
      {"phases", R"([{"until": 1, "viip": {"cog": [0.02]}}])", "/phases/0/viip/cog: expected [x"},
      {"phases", R"([{"until": 1, "viip": {"cog_velocity": [0.02, 0]}}])",
       "/phases/0/viip/cog_velocity: expected [x"},
      {"phases", R"([{"until": 1, "viip": {"cog_velocity": [8, 8, 0]}}])", "at most 10 m/s"},
      {"phases", R"([{"until": 1, "viip": {"cog_velocity": [0,0,0], "steps": 3}}])",
       "expected one goal"},
      {"phases", R"([{"until": 1, "viip": {"step": "on"}}])",
       "'on' is not allowed; the only allowed value is 'in_place'"},
      {"phases", R"([{"until": 1, "viip": {"step": "in_place", "velocity": [1, 0]}}])",
       "/phases/0/viip/velocity: \"velocity\" and \"step\": \"in_place\" exclude each other"},
      {"phases", R"([{"until": 1, "viip": {"velocty": [1, 0]}}])", "did you mean 'velocity'?"},
      {"phases", R"([{"until": 1, "viip": {"jump": {"height": 0}}}])",
       "/phases/0/viip/jump/height: 0 is too small"},
      {"phases", R"([{"until": 0, "support": "both"}])",
       "/phases/0/until: this phase begins at 0 s and ends at 0 s"},
      {"phases", R"([{"until": 2, "support": "both"}, {"until": 1, "support": "both"}])",
       "/phases/1/until: this phase begins at 2 s and ends at 1 s; give a later time. If the 1 s "
       "are counted from the beginning of this phase, write \"duration\" in place of \"until\""},
      {"keyframes", R"([{"t": 2, "zmp": "center"}, {"t": 1.5, "zmp": "center"}])",
       "give a later time. If the 1.5 s are counted from the keyframe before, write \"after\" in "
       "place "
       "of \"t\""},
      {"keyframes", R"([{"t": 2, "zmp": "center"}, {"t": 2300, "zmp": "center"},
                        {"t": 2.6, "zmp": "center"}])",
       "Perhaps the time of /keyframes/1 should be 2.3 s and not 2300 s. If so, correct the time "
       "there"},
      {"phases", R"([{"until": 1, "support": "left",
                      "swing": {"foot": "right", "to": [0, 0], "lift": 15}}])",
       "/phases/0/swing/lift: 15 is too large; the largest allowed value is 10 m. Lengths are in "
       "metres: 15 mm are 0.015 m"},
      {"phases", R"([{"until": -1, "support": "both"}])",
       "-1 is too small; the smallest allowed value is 0"},
      {"phases", R"([{"until": 5000, "support": "both"}])",
       "5000 is too large; the longest pattern is 3600 s. Times are in seconds: 5000 ms are 5 s"},
      {"phases", R"([{"until": 1, "support": "left", "swing": {"foot": "left", "to": [0,0]}}])",
       "/phases/0/swing/foot: the left foot carries the robot"},
      {"phases", R"([{"until": 1, "support": "left", "swing": {"foot": "right", "to": [0]}}])",
       "/phases/0/swing/to: expected [x, y], [x, y, z] or [x, y, z, yaw], found an array of length "
       "1"},
      {"keyframes", R"([{"t": 1, "zmp": "left"}, {"t": 1, "zmp": "left"}])",
       "/keyframes/1/t: this keyframe is at 1 s, but the keyframe before it is at 1 s"},
      {"keyframes", R"([{"t": "nan"}])", "expected a number, found the string"},
      {"keyframes", R"([{"t": "1 s"}])", "/keyframes/0/t: expected a number"},
      {"keyframes", R"([{"t": null}])", "/keyframes/0/t: expected a number, found null"},
      {"keyframes", R"([{"t": true}])", "/keyframes/0/t: expected a number, found true"},
      {"keyframes", R"([{"t": 1e999}])", "p.json"},
      {"keyframes", R"([{"t": NaN}])", "p.json:3:"},
      {"keyframes", R"([{"t": 1, "fz": 1e7}])",
       "is out of range; numbers must be from -1e6 to 1e6"},
      {"keyframes", R"([{"t": 1, "fz": -1}])",
       "/keyframes/0/fz: -1 is too small; the smallest allowed value is 0"},
      {"keyframes", R"([{"t": 1, "zmp": "middle"}])",
       "'middle' is not allowed; the allowed values are left, right, center"},
      {"keyframes", R"([{"t": 1, "zmp": [1]}])",
       "/keyframes/0/zmp: expected [x, y], found an array of length 1"},
      {"keyframes", R"([{"t": 1, "zmp": 3}])",
       "expected \"left\", \"right\", \"center\" or [x, y]"},
      {"keyframes", R"([{"t": 1, "torso": [0, 10, 0]}])",
       "/keyframes/0/torso: expected an object, found an array of length 3; the keys allowed here "
       "are "
       "roll, pitch, yaw"},
      {"keyframes", R"([{"t": 1, "cog": {"z": 1}}])", "/keyframes/0/cog/z: unknown key"},
      {"keyframes", R"([{"t": 1, "cog": {}}])",
       "/keyframes/0/cog: the object is empty; give x, y or height"},
      {"keyframes", R"([{"t": 1, "torso": {}}])",
       "/keyframes/0/torso: the object is empty; give roll, pitch or yaw"},
      {"keyframes", R"([{"t": 1, "posture": 3}])", "expected the name of a posture"},
      {"keyframes", R"([{"t": 1, "posture": {"l_knee": "9O"}}])",
       "/keyframes/0/posture/l_knee: expected a number"},
      {"keyframes", R"([{"t": 1, "posture": {"l_knee": 1}, "joints": {"l_knee": 2}}])",
       "/keyframes/0/joints/l_knee: the joint is already set"},
      {"keyframes", R"([{"t": 1, "interpolation": "minimum jerk"}])",
       "did you mean 'minimum_jerk'?"},
      {"keyframes", R"([{"t": 1, "weights": {"l_knee": 0}}])",
       "a weight must be above 0, but it is 0"},
      {"keyframes", R"([{"t": 1, "t": 2}])", "'t' appears twice"},
      {"units", R"({"angle": "grad"})",
       "/units/angle: 'grad' is not allowed; the allowed values are deg, rad"},
      {"units", R"({"angle": "deg", "length": "mm"})",
       "/units/length: 'mm' is not allowed; the only allowed value is 'm'"},
      {"start", R"({"middle": [0, 0]})", "/start/middle: unknown key"},
      {"defaults", R"({"cog_height": 0})",
       "/defaults/cog_height: this value must be above 0, but it is 0"},
      {"defaults", R"({"cog_model": "point"})",
       "/defaults/cog_model: 'point' is not allowed; the allowed values are full, point_mass"},
      {"world", R"({"friction": -0.1})", "/world/friction: -0.1 is too small"},
      {"world", R"({"ground": "hilly"})",
       "/world/ground: 'hilly' is not allowed; the only allowed value is 'flat'"},
      {"controller", R"({"type": "pid"})",
       "/controller/type: 'pid' is not allowed; the allowed values are none, dtad, dtad-literal, "
       "viip, viip-landings, "
       "viip-nofeedback, preview, foot-guided, dcm-step"},
      {"controller", R"({"type": "dtad", "gains": {"q": 1, "k": 2, "d": 1}})",
       "q determines k and d"},
      {"controller", R"({"type": "dtad", "gains": {"k": 2}})",
       "only one of the gains k and d is given"},
      {"scenario", R"([{"type": "kick"}])",
       "/scenario/0/type: 'kick' is not allowed; the allowed values are impulse, force, torque, "
       "payload"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0], "impulse": 1}])",
       "/scenario/0/impulse: a disturbance of type \"force\""},
      {"scenario", R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0]}])",
       "/scenario/0: the key 'force' is missing"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [0,0,0], "force": 1}])",
       "/scenario/0/direction: the vector has no direction"},
      {"scenario", R"([{"type": "payload", "at": 1, "mass": 1}])",
       "/scenario/0: the key 'on' is missing"},
      {"scenario", R"([{"type": "payload", "at": 1, "on": "cog", "mass": 1}])",
       "/scenario/0/on: a payload needs a link"},
      {"scenario", R"([{"type": "friction", "at": 1, "friction": -0.1}])",
       "/scenario/0/friction: -0.1 is too small"},
      {"scenario", R"([{"type": "friction", "at": 1, "mass": 1}])",
       "/scenario/0/mass: a disturbance of type \"friction\" does not have this key; its keys "
       "are \"at\", \"duration\", friction"},
      {"scenario", R"([{"type": "floor", "at": 1, "duration": 0, "pitch": 3}])",
       "/scenario/0/duration: a motion of the floor needs a duration"},
      {"scenario", R"([{"type": "floor", "at": 1, "duration": 1}])",
       "/scenario/0: the floor does not move"},
      {"scenario", R"([{"type": "floor", "at": 1, "duration": 1, "shape": "sine", "pitch": 3}])",
       "/scenario/0: the key 'frequency' is missing"},
      {"scenario", R"([{"type": "bump", "at": 1, "height": 0.01}])",
       "/scenario/0: a bump needs a foot, or a position"},
      {"scenario", R"([{"type": "gain_loss", "at": 1, "share": 1.5}])",
       "/scenario/0/share: 1.5 is too large; the largest allowed value is 1"},
      {"scenario", R"([{"type": "joint_friction", "at": 1}])",
       "/scenario/0: joint friction needs \"coulomb\" or \"viscous\""},
      {"world", R"({"blocks": [{"height": 0.01}]})", "/world/blocks/0: the key 'x' is missing"},
      {"world", R"({"blocks": [{"x": [0.2, 0.1], "y": [0, 1], "height": 0.01}]})",
       "/world/blocks/0/x: the range is empty: [from, to] needs from < to, but"},
      {"world", R"({"blocks": [{"x": [0, 1], "position": [0, 1], "radius": 1, "height": 0.01}]})",
       "/world/blocks/0/x: the block has keys of a rectangle"},
      {"world", R"({"field": {"origin": [0, 0], "spacing": 0, "heights": [[0, 0], [0, 0]]}})",
       "/world/field/spacing: this value must be above 0, but it is 0"},
      {"world", R"({"field": {"origin": [0, 0], "spacing": 1, "heights": [[0, 0], [0]]}})",
       "/world/field/heights/1: expected 2 to 512 heights"},
      {"world", R"({"motion": [{"at": 0, "duration": 1, "frequency": 1, "roll": 1}]})",
       "/world/motion/0/frequency: only a sine"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": -1, "direction": [1,0,0], "force": 1}])",
       "/scenario/0/duration: -1 is too small"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0], "force": 1, "point": [0,0,0]}])",
       "/scenario/0/point: a push at a point needs a link"},
      {"parameters", R"({"a": "1"})", "/parameters/a: expected a number"},
      {"tolerances", R"({"foot_slip": -1})", "/tolerances/foot_slip: -1 is too small"},
      {"repair", R"({"look": {}})", "/repair/look: unknown key; did you mean 'lock'?"},
      {"repair", R"({"lock": ["l_knee"]})", "/repair/lock: expected an object"},
      {"repair", R"({"lock": {"joints": "l_knee"}})", "/repair/lock/joints: expected an array"},
      {"repair", R"({"lock": {"feet": ["lft"]}})",
       "/repair/lock/feet/0: 'lft' is not allowed; the allowed values are"},
      {"repair", R"({"lock": {"keyframes": [99]}})",
       "/repair/lock/keyframes/0: 99 is not the number of a keyframe; keyframes are numbered"},
      {"repair", R"({"lock": {"keyframes": [-1]}})", "-1 is not the number of a keyframe"},
      {"repair", R"({"lock": {"keyframes": [1.5]}})",
       "/repair/lock/keyframes/0: expected a whole number"},
      {"repair", R"({"lock": {"windows": [[2, 1]]}})",
       "/repair/lock/windows/0: the window must end after it begins, but it begins at 2 s and ends "
       "at 1 s"},
      {"repair", R"({"lock": {"windows": [1, 2]}})", "/repair/lock/windows/0: expected an array"},
      {"repair", R"({"lock": {"windows": [[-1, 2]]}})",
       "-1 s is outside the range of times, 0 to 3600 s"},
      {"repair", R"({"weights": {"l_knee": 0}})",
       "/repair/weights/l_knee: a weight must be above 0, but it is 0. If the joint must not "
       "change, lock the joint"},
      {"repair", R"({"trust": "force"})",
       "/repair/trust: 'force' is not allowed; the allowed values are"},
      {"repair", R"({"margin": 0.2})",
       "/repair/margin: 0.2 is too large; the largest allowed value is 0.1"},
      {"repair", R"({"safety": -1})",
       "/repair/safety: -1 is too small; the smallest allowed value is 0"},
      {"keyframes", R"([{"t": "${a}"}])", "unknown parameter 'a'"},
      {"keyframes", R"([{"t": "${a"}])",
       "/keyframes/0/t: expression \"${a\": the closing } is missing; write a parameter as "
       "${name}"},
      {"table", "\"absent.csv\"", "absent.csv: no such file"},
      {"include", "\"absent.json\"", "absent.json: no such file"},
      {"include", "\".\"", "this is a folder, but a file is needed"},
      {"correction", R"({"begin": 0, "spacing": 0, "columns": [], "coefficients": []})",
       "/correction/spacing: this value must be above 0, but it is"},
      {"correction", R"({"begin": 0, "spacing": 1, "columns": ["base.x[m]"], "coefficients": []})",
       "/correction/columns: the column 'base.y[m]' is missing"},
  };
  return cases;
}

}  // namespace ayumi::test
