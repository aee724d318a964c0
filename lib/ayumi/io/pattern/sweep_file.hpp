#pragma once
// The cases of a sweep: the key "sweep" of a study file ("ayumi.study/1"). A case is a set of
// settings (pattern, parameters, robot, law, gains, world, disturbances, seed). The study combines
// lists, products and Latin hypercubes of them. Cases have numbers and are made one at a time, so a
// study may have millions. docs/formats.md, "Sweeps", is the specification.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// A number or a word. Switches are 0 or 1.
using SettingValue = std::variant<double, std::string>;
/// The settings by name: "pattern", "set.stride", "gain.ka", ...
using Settings = std::map<std::string, SettingValue>;

/// Results that are kept for each case.
struct SweepMeasures {
  bool verdict = true, margins = false, energy = false;  ///< these three share one simulation
  bool check = false, repair = false, thresholds = false;
};

/// The push study of the measure "thresholds".
struct SweepThresholds {
  std::vector<double> times;  ///< times of the pushes [s]; empty for the phases of a push study
  int directions = 8, replicas = 0;
  double step = 0.06, cap = 2.4, duration = 0.02;
};

class SweepStudy {
 public:
  /// Largest number of cases. Chosen: their numbers take about 100 MB of memory.
  static constexpr long kMostCases = 100'000'000;

  /// Reads the bytes of a study file; `path` names it in messages. Throws Error(bad_pattern) "file:
  /// /json/pointer: what, what to do".
  SweepStudy(const std::string& text, const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  const std::filesystem::path& file() const { return file_; }
  const std::string& text() const { return text_; }
  const Study& uncertainty() const { return uncertainty_; }  ///< may be empty
  const SweepMeasures& measures() const { return measures_; }
  const std::vector<std::string>& measure_names() const { return measure_names_; }
  const SweepThresholds& thresholds() const { return thresholds_; }

  /// Number of cases.
  long size() const;
  /// The names of the settings that differ between cases, sorted.
  const std::vector<std::string>& axes() const { return axes_; }
  /// All settings of the case with this number.
  Settings settings(long number) const;
  /// All words that a setting has in any case, for example all patterns; sorted.
  std::vector<std::string> words(const std::string& setting) const;
  /// The name of a setting that some case has, with one of its values and its JSON pointer.
  struct Named {
    SettingValue value;
    std::string pointer;
  };
  const std::map<std::string, Named>& named() const { return named_; }

  /// The world and the disturbances that the settings name; if they name none, those of the
  /// pattern. Throws Error(bad_pattern) with the place in the file.
  std::optional<World> world(const Settings& settings) const;
  std::optional<std::vector<Disturbance>> disturbances(const Settings& settings) const;

  struct Part;  ///< a list, product, axis or hypercube

 private:
  struct Document;

  std::string name_, text_;
  std::filesystem::path file_;
  std::shared_ptr<const Document> document_;
  std::shared_ptr<const Part> cases_;
  Settings fixed_;
  std::vector<std::string> axes_;
  std::map<std::string, Named> named_;
  Study uncertainty_;
  SweepMeasures measures_;
  std::vector<std::string> measure_names_;
  SweepThresholds thresholds_;
};

/// The text of a setting: the shortest number, or the word.
std::string setting_text(const SettingValue& value);
/// The number of a setting, or `otherwise` if there is none.
double number_of(const Settings& settings, const std::string& name, double otherwise);
/// The word of a setting, or "" if there is none.
std::string word_of(const Settings& settings, const std::string& name);

}  // namespace ayumi
