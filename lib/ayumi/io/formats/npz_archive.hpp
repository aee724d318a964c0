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

/// An array of strings. NumPy stores 4 bytes for each character, and one length for all strings.
std::string npy_words(const std::vector<std::string>& words, const std::vector<size_t>& shape);

/// An array of numbers of the type "<f8".
std::string npy_numbers(const std::vector<double>& numbers, const std::vector<size_t>& shape);

struct NamedFile {
  std::string name, bytes;
};

/// An archive without compression and without times: the same files give the same bytes.
std::string zip_of(const std::vector<NamedFile>& files);

/// An array that was read.
struct NpyArray {
  std::vector<size_t> shape;
  std::vector<double> numbers;     ///< numbers of a numeric array, the last index fastest (C order)
  std::vector<std::string> words;  ///< words of an array of strings
  std::string refused = {};        ///< reason why the content was not read; "" if it was read
};

/// The arrays by name. Throws Error(bad_file) for a file that is not an archive, for a truncated
/// array, and for more than 100 MB of numbers. Arrays of other kinds (objects) have the reason in
/// `refused`.
std::map<std::string, NpyArray> read_npz(const std::string& bytes, const std::string& file);

}  // namespace ayumi
