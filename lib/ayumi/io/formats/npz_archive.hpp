#pragma once
// Archives of NumPy arrays (.npz).

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ayumi {

/// An array as a .npy file of version 1.0; `data` has the bytes of `type` ("<f8") in the order of
/// C.
std::string npy_bytes(const std::string& type, const std::vector<size_t>& shape, std::string data);

/// Strings; NumPy stores 4 bytes per character and one length for all.
std::string npy_words(const std::vector<std::string>& words, const std::vector<size_t>& shape);

/// Numbers as "<f8".
std::string npy_numbers(const std::vector<double>& numbers, const std::vector<size_t>& shape);

struct NamedFile {
  std::string name, bytes;
};

/// An archive without compression and without times: the same files give the same bytes.
std::string zip_of(const std::vector<NamedFile>& files);

/// An array that was read.
struct NpyArray {
  std::vector<size_t> shape;
  std::vector<double> numbers;     ///< of a numeric array, in the order of C
  std::vector<std::string> words;  ///< of an array of strings
  std::string refused = {};        ///< why the content was not read; "" where it was
};

/// The arrays by name. Throws Error(bad_file) for what is no archive, a truncated array, and more
/// than 100 MB of numbers. Arrays of other kinds (objects) say so in `refused`.
std::map<std::string, NpyArray> read_npz(const std::string& bytes, const std::string& file);

}  // namespace ayumi
