#include "ayumi/io/run/sha256_stream.hpp"

#include <openssl/evp.h>

#include <array>

#include "ayumi/base/error.hpp"
#include "ayumi/base/regular_file.hpp"

namespace ayumi {

namespace {

void require_hashed(int done) { require(done == 1, "sha256: the cryptographic library refused"); }

}  // namespace

struct Sha256Stream::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256Stream::Sha256Stream() : state_(std::make_unique<State>()) {
  require_hashed(EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr));
}

Sha256Stream::~Sha256Stream() = default;

void Sha256Stream::add(std::string_view bytes) {
  require_hashed(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()));
}

std::string Sha256Stream::digits() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  require_hashed(EVP_DigestFinal_ex(state_->context, digest.data(), &length));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

std::string sha256_of_file(const std::filesystem::path& path, size_t max_bytes) {
  // Size of a piece [bytes]. Chosen: large enough that the calls of the system cost nothing.
  constexpr size_t kPiece = size_t{1} << 20;
  RegularFile file(path, max_bytes);
  Sha256Stream hash;
  std::string piece(kPiece, '\0');
  while (const size_t got = file.read(piece.data(), piece.size()))
    hash.add(std::string_view(piece).substr(0, got));
  return hash.digits();
}

}  // namespace ayumi
