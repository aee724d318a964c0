#include "ayumi/io/formats/log_npz.hpp"

#include <zip.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/log_about.hpp"

namespace ayumi {

namespace {

static_assert(std::endian::native == std::endian::little, "arrays are little-endian");

// Definition: a .npy file of version 1.0; its data begin at a multiple of 64 bytes.
constexpr char kNpyMagic[] = "\x93NUMPY\x01";
constexpr size_t kAlignment = 64;

std::string shape_text(const std::vector<size_t>& shape) {
  std::string text = "(";
  for (const size_t size : shape) text += std::to_string(size) + ",";
  if (shape.size() > 1) text.pop_back();  // Python: (3,) and (3,4)
  return text + ")";
}

std::string npy(const std::string& type, const std::vector<size_t>& shape, std::string data) {
  std::string head =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
  const size_t fixed = 10;  // Definition: magic word, version and length of the head
  head.append(kAlignment - 1 - (fixed + head.size()) % kAlignment, ' ');
  head += '\n';
  std::string bytes(kNpyMagic, 7);
  bytes += '\0';
  bytes += static_cast<char>(head.size() & 0xff);
  bytes += static_cast<char>(head.size() >> 8);
  return bytes + head + std::move(data);
}

// Valid UTF-8 as code points; any other byte as U+FFFD.
std::u32string code_points(const std::string& text) {
  std::u32string points;
  for (size_t at = 0; at < text.size();) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const size_t size = lead < 0x80    ? 1
                        : lead >= 0xf0 ? 4
                        : lead >= 0xe0 ? 3
                        : lead >= 0xc2 ? 2
                                       : 0;
    char32_t point = size <= 1 ? lead : lead & (0xff >> (size + 1));
    bool valid = size > 0 && at + size <= text.size();
    for (size_t i = 1; valid && i < size; ++i) {
      const auto next = static_cast<unsigned char>(text[at + i]);
      valid = (next & 0xc0) == 0x80;
      point = (point << 6) | (next & 0x3f);
    }
    points.push_back(valid ? point : U'\ufffd');
    at += valid ? size : 1;
  }
  return points;
}

// Strings of NumPy have 4 bytes per character and one length for all.
std::string npy(const std::vector<std::string>& words, const std::vector<size_t>& shape) {
  std::vector<std::u32string> wide;
  size_t longest = 1;
  for (const std::string& word : words) {
    wide.push_back(code_points(word));
    longest = std::max(longest, wide.back().size());
  }
  std::string data;
  for (std::u32string& word : wide) {
    word.resize(longest, U'\0');
    data.append(reinterpret_cast<const char*>(word.data()), word.size() * sizeof(char32_t));
  }
  return npy("<U" + std::to_string(longest), shape, std::move(data));
}

std::string npy(const LogTable& table, size_t first, const NpzArray& array) {
  const size_t width = array.shape.size() > 1 ? array.shape[1] : 1;
  std::string data;
  data.reserve(table.rows * width * sizeof(double));
  for (size_t row = 0; row < table.rows; ++row)
    data.append(reinterpret_cast<const char*>(&table.values[row * table.columns + first]),
                width * sizeof(double));
  return npy("<f8", array.shape, std::move(data));
}

struct NamedFile {
  std::string name, bytes;
};

// An archive without compression and without times: the same files give the same bytes.
std::string zip_of(const std::vector<NamedFile>& files) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const target = zip_source_buffer_create(nullptr, 0, 0, &error);
  require(target != nullptr, "no memory for an archive");
  zip_source_keep(target);
  zip_t* const archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  require(archive != nullptr, "an archive cannot be made");
  for (const NamedFile& file : files) {
    zip_source_t* const source =
        zip_source_buffer(archive, file.bytes.data(), file.bytes.size(), 0);
    const zip_int64_t index = zip_file_add(archive, file.name.c_str(), source, ZIP_FL_ENC_UTF_8);
    require(index >= 0, "a file cannot be added to an archive");
    const auto at = static_cast<zip_uint64_t>(index);
    zip_set_file_compression(archive, at, ZIP_CM_STORE, 0);
    constexpr zip_uint16_t first_of_january_1980 =
        0x21;  // Definition: the first day of this format
    zip_file_set_dostime(archive, at, 0, first_of_january_1980, 0);
  }
  require(zip_close(archive) == 0, "an archive cannot be written");
  zip_stat_t stat;
  zip_source_stat(target, &stat);
  std::string bytes(stat.size, '\0');
  zip_source_open(target);
  const zip_int64_t got = zip_source_read(target, bytes.data(), bytes.size());
  require(got == static_cast<zip_int64_t>(bytes.size()), "an archive cannot be read");
  zip_source_close(target);
  zip_source_free(target);
  return bytes;
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
  files.push_back({"joints.npy", npy(log.joints, {log.joints.size()})});
  files.push_back({"about.npy", npy({about_text(table, log)}, {})});
  return zip_of(files);
}

}  // namespace ayumi
