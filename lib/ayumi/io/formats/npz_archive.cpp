#include "ayumi/io/formats/npz_archive.hpp"

#include <zip.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "ayumi/base/error.hpp"
#include "ayumi/base/utf8.hpp"

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

// The code points of a UTF-8 text; every invalid byte becomes U+FFFD.
std::u32string code_points(const std::string& text) {
  std::u32string points;
  for (size_t at = 0; at < text.size();) {
    char32_t point = U'\ufffd';
    const size_t size = text::utf8_character(std::string_view(text).substr(at), point);
    points.push_back(size > 0 ? point : U'\ufffd');
    at += std::max<size_t>(size, 1);
  }
  return points;
}

// The text of a cell of the type "<U8" as UTF-8.
std::string word_of(const char* data, size_t length) {
  std::string word;
  for (size_t i = 0; i < length; ++i) {
    char32_t c = 0;
    std::memcpy(&c, data + 4 * i, 4);
    if (c == 0) break;
    if (c < 0x80) {
      word += static_cast<char>(c);
    } else if (c < 0x800) {
      word += static_cast<char>(0xc0 | (c >> 6));
      word += static_cast<char>(0x80 | (c & 0x3f));
    } else {
      word += static_cast<char>(0xe0 | ((c >> 12) & 0x0f));
      word += static_cast<char>(0x80 | ((c >> 6) & 0x3f));
      word += static_cast<char>(0x80 | (c & 0x3f));
    }
  }
  return word;
}

template <typename Number>
void take_numbers(const std::string& bytes, size_t at, size_t count, NpyArray& array) {
  array.numbers.resize(count);
  for (size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, bytes.data() + at + i * sizeof(Number), sizeof(Number));
    array.numbers[i] = static_cast<double>(number);
  }
}

// The items of an array of this shape in C order (the last index varies fastest); the file has
// Fortran order (the first index varies fastest).
template <typename Item>
std::vector<Item> in_order_of_c(const std::vector<Item>& file, const std::vector<size_t>& shape) {
  std::vector<Item> items;
  items.reserve(file.size());
  std::vector<size_t> index(shape.size(), 0);
  for (size_t count = 0; count < file.size(); ++count) {
    size_t at = 0;
    for (size_t k = shape.size(); k > 0; --k) at = at * shape[k - 1] + index[k - 1];
    items.push_back(file[at]);
    for (size_t k = shape.size(); k > 0 && ++index[k - 1] == shape[k - 1]; --k) index[k - 1] = 0;
  }
  return items;
}

// The text between quotes, or the word, after `'key':`.
std::string value_in_head(const std::string& head, const std::string& key) {
  const size_t at = head.find("'" + key + "':");
  if (at == std::string::npos) return "";
  size_t begin = head.find_first_not_of(' ', at + key.size() + 3);
  if (begin == std::string::npos) return "";
  if (head[begin] == '\'') return head.substr(begin + 1, head.find('\'', begin + 1) - begin - 1);
  if (head[begin] == '(') return head.substr(begin + 1, head.find(')', begin) - begin - 1);
  return head.substr(begin, head.find_first_of(",}", begin) - begin);
}

/// Largest number of numbers in all arrays together. Chosen: 100 MB.
constexpr size_t kMostNumbers = 100'000'000 / sizeof(double);

NpyArray array_of(const std::string& bytes, const SourcePlace& place) {
  const auto refuse = [&](const std::string& reason) { fail(ErrorCode::bad_file, place, reason); };
  if (bytes.size() < 12 || bytes.compare(0, 6, kNpyMagic, 6) != 0)
    refuse("this is not a NumPy array; save the arrays with numpy.savez");
  // Definition: version 2 has a long head, version 3 has names in UTF-8.
  if (bytes[6] < 1 || bytes[6] > 3)
    refuse("version " + std::to_string(bytes[6]) +
           " of the NumPy format is unknown; Ayumi reads versions 1 to 3");
  const bool long_head = bytes[6] != 1;
  const auto byte = [&](size_t i) {
    return static_cast<size_t>(static_cast<unsigned char>(bytes[i]));
  };
  const size_t fixed = long_head ? 12 : 10;
  size_t length = byte(8) | byte(9) << 8;
  if (long_head) length |= byte(10) << 16 | byte(11) << 24;
  if (fixed + length > bytes.size()) refuse("the array is truncated; save the file again");
  const std::string head = bytes.substr(fixed, length), type = value_in_head(head, "descr");
  NpyArray array;
  size_t count = 1;
  std::string shape = value_in_head(head, "shape") + ",";
  for (size_t at = 0; at < shape.size();) {
    const size_t end = shape.find(',', at), first = shape.find_first_not_of(' ', at);
    if (first < end) {
      size_t size = 0;
      std::from_chars(shape.data() + first, shape.data() + end, size);
      if (size > kMostNumbers || count * std::max<size_t>(size, 1) > kMostNumbers)
        refuse("the array is too large; Ayumi reads at most 100 MB");
      array.shape.push_back(size);
      count *= size;
    }
    at = end + 1;
  }
  const size_t at = fixed + length;
  size_t width = 0;
  if (type.size() > 2) std::from_chars(type.data() + 2, type.data() + type.size(), width);
  const bool text = type.starts_with("<U"), old_text = type.starts_with("|S");
  const size_t item = text ? 4 * width : width;
  if (width > 1000 || (!text && !old_text && width > 8) ||
      !(text || old_text || type.starts_with("<") || type.starts_with("|"))) {
    array.refused = "the type '" + type.substr(0, 12) +
                    "' is unknown; save the array as numbers of the type float64";
    return array;
  }
  if (bytes.size() - at < count * item)
    refuse("the array is truncated: " + std::to_string(bytes.size() - at) + " bytes of " +
           std::to_string(count * item) + "; save the file again");
  if (text)
    for (size_t i = 0; i < count; ++i)
      array.words.push_back(word_of(bytes.data() + at + i * item, width));
  else if (old_text)
    for (size_t i = 0; i < count; ++i)
      array.words.emplace_back(bytes.data() + at + i * item,
                               strnlen(bytes.data() + at + i * item, width));
  else if (type == "<f8")
    take_numbers<double>(bytes, at, count, array);
  else if (type == "<f4")
    take_numbers<float>(bytes, at, count, array);
  else if (type == "<i8" || type == "<u8")
    take_numbers<std::int64_t>(bytes, at, count, array);
  else if (type == "<i4")
    take_numbers<std::int32_t>(bytes, at, count, array);
  else if (type == "<u4")
    take_numbers<std::uint32_t>(bytes, at, count, array);
  else if (type == "<i2")
    take_numbers<std::int16_t>(bytes, at, count, array);
  else if (type == "<u2")
    take_numbers<std::uint16_t>(bytes, at, count, array);
  else if (type == "|i1")
    take_numbers<std::int8_t>(bytes, at, count, array);
  else if (type == "|u1" || type == "|b1")
    take_numbers<std::uint8_t>(bytes, at, count, array);
  else
    array.refused =
        "the type '" + type + "' is unknown; save the array as numbers of the type float64";
  // NumPy chooses this order by itself, for example for root_rot[:, [3, 0, 1, 2]].
  if (value_in_head(head, "fortran_order") == "True") {
    array.numbers = in_order_of_c(array.numbers, array.shape);
    array.words = in_order_of_c(array.words, array.shape);
  }
  return array;
}

}  // namespace

std::string npy_bytes(const std::string& type, const std::vector<size_t>& shape, std::string data) {
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

// Strings of NumPy have 4 bytes per character and one length for all.
std::string npy_words(const std::vector<std::string>& words, const std::vector<size_t>& shape) {
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
  return npy_bytes("<U" + std::to_string(longest), shape, std::move(data));
}

std::string npy_numbers(const std::vector<double>& numbers, const std::vector<size_t>& shape) {
  return npy_bytes(
      "<f8", shape,
      std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)));
}

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

std::map<std::string, NpyArray> read_npz(const std::string& bytes, const std::string& file) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  require(source != nullptr, "no memory for an archive");
  zip_t* const archive = zip_open_from_source(source, ZIP_RDONLY, &error);
  if (!archive) {
    zip_source_free(source);
    fail(ErrorCode::bad_file, {file}, "the archive cannot be opened; the file may be truncated");
  }
  std::map<std::string, NpyArray> arrays;
  std::string refused;
  size_t total = 0;
  const zip_int64_t files = zip_get_num_entries(archive, 0);
  try {
    for (zip_int64_t i = 0; i < files; ++i) {
      const auto at = static_cast<zip_uint64_t>(i);
      zip_stat_t stat;
      if (zip_stat_index(archive, at, 0, &stat) != 0) continue;
      std::string name = stat.name;
      if (!name.ends_with(".npy")) continue;
      name.resize(name.size() - 4);
      total += stat.size;
      if (total > kMostNumbers * sizeof(double))
        fail(ErrorCode::bad_file, {file}, "the arrays are too large; Ayumi reads at most 100 MB");
      zip_file_t* const opened = zip_fopen_index(archive, at, 0);
      std::string content(stat.size, '\0');
      const zip_int64_t got = opened ? zip_fread(opened, content.data(), content.size()) : -1;
      // libzip compares the checksum when the end is read.
      char beyond = 0;
      const bool whole =
          got == static_cast<zip_int64_t>(content.size()) && zip_fread(opened, &beyond, 1) == 0;
      if (opened) zip_fclose(opened);
      if (!whole)
        fail(ErrorCode::bad_file, {file},
             name + ": the array cannot be unpacked; the file may be damaged");
      arrays[name] = array_of(content, {file, name});
    }
  } catch (...) {
    zip_discard(archive);
    throw;
  }
  zip_discard(archive);
  return arrays;
}

}  // namespace ayumi
