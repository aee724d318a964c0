#include "ayumi/io/formats/log_npz.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/npz_archive.hpp"
#include "ayumi/io/run/log_about.hpp"

namespace ayumi {

namespace {

std::string npy(const LogTable& table, size_t first, const NpzArray& array) {
  const size_t width = array.shape.size() > 1 ? array.shape[1] : 1;
  std::string data;
  data.reserve(table.rows * width * sizeof(double));
  for (size_t row = 0; row < table.rows; ++row)
    data.append(reinterpret_cast<const char*>(&table.values[row * table.columns + first]),
                width * sizeof(double));
  return npy_bytes("<f8", array.shape, std::move(data));
}

std::string about_text(const LogTable& table, const SimulationLog& log) {
  nlohmann::ordered_json json = about_log(log);
  json["arrays"] = nlohmann::ordered_json::object();
  const std::vector<NpzArray> arrays = npz_arrays(table);
  for (size_t i = 0; i < arrays.size(); ++i) {
    std::vector<std::string> columns;
    for (size_t c = 0; c < table.quantities[i].columns(); ++c)
      columns.push_back(table.quantities[i].column(c));
    json["arrays"][arrays[i].name] = {
        {"shape", arrays[i].shape}, {"unit", arrays[i].unit}, {"columns", columns}};
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

std::vector<NpzArray> npz_arrays(const LogTable& table) {
  std::vector<NpzArray> arrays;
  for (const LogQuantity& quantity : table.quantities) {
    std::vector<std::string> units;
    for (const std::string& unit : quantity.units)
      if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
    NpzArray array = {quantity.name, text::join(units, ", "), {table.rows}};
    if (!quantity.parts.empty()) array.shape.push_back(quantity.columns());
    arrays.push_back(std::move(array));
  }
  return arrays;
}

std::string log_npz(const LogTable& table, const SimulationLog& log) {
  std::vector<NamedFile> files;
  const std::vector<NpzArray> arrays = npz_arrays(table);
  size_t first = 0;
  for (size_t i = 0; i < arrays.size(); ++i) {
    files.push_back({arrays[i].name + ".npy", npy(table, first, arrays[i])});
    first += table.quantities[i].columns();
  }
  files.push_back({"joints.npy", npy_words(log.joints, {log.joints.size()})});
  files.push_back({"about.npy", npy_words({about_text(table, log)}, {})});
  return zip_of(files);
}

}  // namespace ayumi
