#include "ayumi/io/formats/qianim.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"

namespace ayumi {

namespace {

constexpr double kUsualFrames = 25;  // Definition: frames per second of Choregraphe

/// The keys of one actuator by frame.
struct Curve {
  std::string joint;
  std::map<double, double> keys;
};

// Number of frames per second, by the name of the attribute that states it. That of the editor is
// only what an editor shows.
using Rates = std::map<std::string, double>;

std::string words_of_no_rate(const std::string& name, double fps) {
  return name + " is " + text::brief(fps) + "; give the number of frames per second";
}

void find_curves(const MotionInput& source, const TiXmlElement& element, Rates& rates,
                 std::vector<Curve>& curves) {
  for (const char* name : {"fps", "editor:fps"})
    if (const char* const text = element.Attribute(name)) {
      const auto line = static_cast<size_t>(element.Row());
      const double fps = source.number(text, line, name);
      const double before = rates.emplace(name, fps).first->second;
      if (std::string(name) != "fps") continue;
      if (!(fps > 0)) source.refuse(line, words_of_no_rate(name, fps));
      if (fps != before)
        source.refuse(line, name + (" is " + text::brief(fps)) +
                                ", but another part of the file has " + text::brief(before) +
                                "; give all parts the same rate");
    }
  if (std::string(element.Value()) != "ActuatorCurve") {
    for (const TiXmlElement* child = element.FirstChildElement(); child;
         child = child->NextSiblingElement())
      find_curves(source, *child, rates, curves);
    return;
  }
  Curve curve;
  const char* const actuator = element.Attribute("actuator");
  if (!actuator) source.refuse(static_cast<size_t>(element.Row()), "a curve has no actuator");
  curve.joint = actuator;
  const char* const unit = element.Attribute("unit");
  const bool degrees = !unit || std::string(unit) == "0";
  for (const TiXmlElement* key = element.FirstChildElement("Key"); key;
       key = key->NextSiblingElement("Key")) {
    const auto line = static_cast<size_t>(key->Row());
    const auto number = [&](const char* name) {
      const char* const text = key->Attribute(name);
      if (!text) source.refuse(line, std::string("a key has no ") + name);
      return source.number(text, line, name);
    };
    const double frame = number("frame");
    if (!curve.keys.empty() && !(frame > curve.keys.rbegin()->first))
      source.refuse(line, "frame " + text::brief(frame) + " does not come after frame " +
                              text::brief(curve.keys.rbegin()->first) +
                              " of the key before; frames must increase");
    curve.keys[frame] = number("value") * (degrees ? kRadiansPerDegree : 1);
  }
  for (const Curve& other : curves)
    if (other.joint == curve.joint)
      source.refuse(static_cast<size_t>(element.Row()),
                    "the actuator '" + curve.joint + "' has two curves");
  if (!curve.keys.empty()) curves.push_back(std::move(curve));
}

}  // namespace

std::string recognize_qianim(const MotionInput& source) {
  const size_t first = source.bytes.find_first_not_of(" \t\r\n");
  return first != std::string::npos && source.bytes[first] == '<' &&
                 source.bytes.find("<ActuatorCurve") != std::string::npos
             ? "the file is XML with ActuatorCurve"
             : "";
}

MotionFile read_qianim(const MotionInput& source) {
  TiXmlDocument document;
  document.Parse(source.bytes.c_str());
  if (document.Error() || !document.RootElement())
    source.refuse(static_cast<size_t>(std::max(document.ErrorRow(), 0)),
                  std::string("this is not valid XML: ") + document.ErrorDesc() +
                      "; the file may be truncated",
                  true);
  if (const TiXmlElement* second = document.RootElement()->NextSiblingElement())
    source.refuse(static_cast<size_t>(second->Row()),
                  "a second <" + second->ValueStr() +
                      "> begins here, but a file has one; cut the file before this line");
  Rates rates;
  std::vector<Curve> curves;
  find_curves(source, *document.RootElement(), rates, curves);
  if (curves.empty())
    source.refuse(0, "the file has no key, so there is no motion to read; write the file again");
  const double rate = rates.contains("fps")          ? rates["fps"]
                      : rates.contains("editor:fps") ? rates["editor:fps"]
                                                     : kUsualFrames;
  if (!(rate > 0)) source.refuse(0, words_of_no_rate("editor:fps", rate));
  std::map<double, Eigen::Index> frames;
  for (const Curve& curve : curves)
    for (const auto& [frame, value] : curve.keys) frames[frame] = 0;
  MotionFile motion;
  for (auto& [frame, row] : frames) {
    row = static_cast<Eigen::Index>(motion.times.size());
    motion.times.push_back(frame / rate);
  }
  motion.values.setConstant(static_cast<Eigen::Index>(frames.size()),
                            static_cast<Eigen::Index>(curves.size()),
                            std::numeric_limits<double>::quiet_NaN());
  for (size_t j = 0; j < curves.size(); ++j) {
    motion.joints.push_back(curves[j].joint);
    for (const auto& [frame, value] : curves[j].keys)
      motion.values(frames[frame], static_cast<Eigen::Index>(j)) = value;
  }
  motion.keys = true;
  motion.notes = {"units: degrees, as the format defines them; " + text::brief(rate) +
                  " frames per second; the tangents of the curves are not read"};
  return motion;
}

std::vector<WrittenFile> write_qianim(const RobotModel&, const MotionFile& motion) {
  const long rate = std::lround(motion.rate);
  if (std::abs(motion.rate - static_cast<double>(rate)) > 1e-6 * motion.rate)
    fail(ErrorCode::bad_file,
         "a .qianim has a whole number of frames per second, but the motion has " +
             text::brief(motion.rate, 8) + "; choose a whole number with --rate");
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n"
      "<Animation xmlns:editor=\"http://www.ald.softbankrobotics.com/animation/editor\" "
      "typeVersion=\"2.0\" editor:fps=\"" +
      std::to_string(rate) + "\">\n";
  for (size_t j = 0; j < motion.joints.size(); ++j) {
    text += "    <ActuatorCurve fps=\"" + std::to_string(rate) + "\" actuator=\"" +
            motion.joints[j] + "\" mute=\"false\" unit=\"0\">\n";
    for (Eigen::Index k = 0; k < motion.rows(); ++k) {
      char degrees[40];
      std::snprintf(degrees, sizeof degrees, "%.12g",
                    motion.values(k, static_cast<Eigen::Index>(j)) / kRadiansPerDegree);
      text += "        <Key value=\"" + std::string(degrees) + "\" frame=\"" + std::to_string(k) +
              "\" />\n";
    }
    text += "    </ActuatorCurve>\n";
  }
  return {{"", text + "</Animation>\n"}};
}

}  // namespace ayumi
