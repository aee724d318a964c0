#include "ayumi/io/run/sha256.hpp"

#include "ayumi/io/run/sha256_stream.hpp"

namespace ayumi {

std::string sha256(std::string_view bytes) {
  Sha256Stream stream;
  stream.add(bytes);
  return stream.digits();
}

}  // namespace ayumi
