#include "ayumi/io/robot/mesh.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <optional>

#include "ayumi/base/child_process.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/mesh_cache.hpp"
#include "ayumi/io/robot/mesh_message.hpp"
#include "ayumi/io/robot/mesh_reader_place.hpp"
#include "ayumi/io/run/sha256.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Exchange = ChildProcess::Exchange;

// Largest number of readers at the same time. Chosen: each takes 3 ms to start, and a robot has
// about 20 small meshes.
constexpr size_t kMeshReaders = 4;
constexpr size_t kMostCompanionBytes = size_t{1} << 30;
constexpr size_t kLongestCompanionName = 4096;
// Longest wait of the caller before it asks whether the work should continue. Chosen: Ctrl-C is
// answered at once, and the wait costs nothing.
constexpr std::chrono::milliseconds kPause(50);
// Largest number of bytes of a refusal. Chosen: a line or two of a message for people.
constexpr size_t kLongestRefusal = 400;
// Size of the pieces in which an answer is received [bytes]. Chosen: an answer that states a large
// size but then ends takes no memory for this size.
constexpr size_t kAnswerPiece = size_t{4} << 20;

// Environment variables that the reader receives. The archive of the program has its own shared
// libraries; the other variables are those of sanitizers.
const std::vector<std::string> kReaderEnvironment = {"LD_LIBRARY_PATH", "ASAN_OPTIONS",
                                                     "UBSAN_OPTIONS", "LSAN_OPTIONS"};
#ifdef __SANITIZE_ADDRESS__
constexpr bool kReaderErrors = true;  // the sanitizer writes its reports there
#else
constexpr bool kReaderErrors = false;
#endif

const char* const kRemedy = "; export the mesh again as STL, OBJ, COLLADA or glTF";

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

// The messages of the reader may contain text from the mesh file.
std::string harmless(std::string words) {
  if (words.size() > kLongestRefusal) words = words.substr(0, kLongestRefusal) + "...";
  for (char& c : words)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return words;
}

std::string mebibytes(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

// A mesh that a reader could not finish. If the same reader read other meshes before, they may be
// the cause.
struct ReaderLost {
  std::string message;
  bool try_again = true;
};

// A reader, used for one mesh after the other.
class MeshReader {
 public:
  MeshReader(const MeshReading& reading, const std::atomic<bool>& stop)
      : reading_(reading),
        stop_(stop),
        program_(reading.program.empty() ? find_mesh_reader() : reading.program),
        cache_(reading.cache) {}

  TriangleMesh read(const MeshRequest& request) {
    path_ = request.path;
    if (!request.scale.allFinite()) complain("the scale is not finite");
    const std::string bytes = read_file(path_);
    if (bytes.empty()) complain("the mesh file is empty");
    const std::string key =
        MeshCache::key_of(head_of(request), path_.filename().string(), bytes, program_);
    if (std::optional<TriangleMesh> known = kept(key)) return with_textures(std::move(*known));
    while (true) {
      const bool fresh = !child_;
      try {
        if (fresh) child_.emplace(program_, kReaderEnvironment, kReaderErrors);
        child_->set_stop(stop_);
        const std::string answer = ask_reader(request, bytes, fresh);
        TriangleMesh mesh = decode(answer);
        cache_.keep(key, asked_, answer);
        return with_textures(std::move(mesh));
      } catch (const ReaderLost& lost) {
        child_.reset();
        if (fresh || !lost.try_again) complain(lost.message);
      } catch (...) {
        child_.reset();  // the reader may have asked a question
        throw;
      }
    }
  }

 private:
  [[noreturn]] void complain(const std::string& message) const {
    fail(ErrorCode::bad_file, {path_.string()}, message);
  }

  // The answer in the cache. It is trusted as little as one of the reader.
  std::optional<TriangleMesh> kept(const std::string& key) {
    companion_bytes_ = 0;
    try {
      const auto answer =
          cache_.find(key, [this](const std::string& name) { return companion(name); });
      if (answer && answer->size() <= reading_.answer_size) return decode_mesh(*answer);
    } catch (const Error&) {  // the reader finds the error again, and says what is wrong
    }
    return std::nullopt;
  }

  TriangleMesh with_textures(TriangleMesh mesh) const {
    for (MeshPart& part : mesh.parts) part.texture_file = texture_of(part.texture_file);
    return mesh;
  }

  // Sends the request, and receives everything until the answer to it: an encoded mesh.
  std::string ask_reader(const MeshRequest& request, const std::string& bytes, bool fresh) {
    asked_.clear();
    companion_bytes_ = 0;
    child_->set_time(reading_.time);
    // The first message is the greeting. So a program that ends or says something else can be
    // distinguished from a reader that crashed because of the file.
    if (fresh) receive_hello();
    send_request(request, bytes);
    while (true) {
      const MeshMessageHead head = receive_head();
      switch (head.kind) {
        case MeshMessage::ask:
          answer(receive_bytes(head.size, kLongestCompanionName));
          break;
        case MeshMessage::mesh:
          return receive_bytes(head.size, reading_.answer_size);
        case MeshMessage::refusal:
          complain(harmless(receive_bytes(head.size, reading_.answer_size)));
        case MeshMessage::memory:
          throw ReaderLost{"reading this mesh of " + std::to_string(bytes.size()) +
                           " bytes takes more memory than the " +
                           mebibytes(reading_.base_memory +
                                     reading_.memory_per_byte * (bytes.size() + companion_bytes_)) +
                           " that a file of this size may take. The file may be broken: export the "
                           "mesh again, or simplify it"};
        default:
          throw ReaderLost{"the answer of the program that reads meshes is not valid (message " +
                           std::to_string(static_cast<std::uint32_t>(head.kind)) + ")" + kRemedy};
      }
    }
  }

  MeshRequestHead head_of(const MeshRequest& request) const {
    MeshRequestHead about;
    for (int i = 0; i < 3; ++i) about.scale[i] = request.scale[i];
    about.base_memory = reading_.base_memory;
    about.memory_per_byte = reading_.memory_per_byte;
    about.cpu_time = reading_.cpu_time;
    about.name_size = path_.filename().string().size();
    return about;
  }

  void send_request(const MeshRequest& request, const std::string& bytes) {
    const std::string name = path_.filename().string();
    const MeshRequestHead about = head_of(request);
    send_head(MeshMessage::request, sizeof about + name.size() + bytes.size());
    need(child_->send(&about, sizeof about));
    need(child_->send(name.data(), name.size()));
    need(child_->send(bytes.data(), bytes.size()));
  }

  void send_head(MeshMessage kind, size_t size) {
    const MeshMessageHead head{kind, 0, size};
    need(child_->send(&head, sizeof head));
  }

  void receive_hello() {
    MeshMessageHead head;
    const Exchange exchange = child_->receive(&head, sizeof head);
    if (exchange == Exchange::closed)
      fail(ErrorCode::bad_file, {program_.string()},
           "this program, which reads meshes, ended before it was ready (" + child_->end().words() +
               "); start the program by itself to see its message, or install Ayumi again");
    need(exchange);
    if (head.kind != MeshMessage::hello || head.size != kMeshMessageVersion)
      fail(
          ErrorCode::bad_file, {program_.string()},
          "this program, which reads meshes, belongs to another version of Ayumi; install Ayumi as "
          "a whole");
  }

  MeshMessageHead receive_head() {
    MeshMessageHead head;
    need(child_->receive(&head, sizeof head));
    return head;
  }

  std::string receive_bytes(std::uint64_t size, std::uint64_t most) {
    if (size > most)
      throw ReaderLost{"the mesh takes " + std::to_string(size) + " bytes, but at most " +
                       std::to_string(most) + " bytes are accepted; simplify the mesh"};
    std::string bytes;
    while (bytes.size() < size) {
      const size_t got = bytes.size();
      bytes.resize(got + std::min<size_t>(size - got, std::max(kAnswerPiece, got)));
      need(child_->receive(bytes.data() + got, bytes.size() - got));
    }
    return bytes;
  }

  TriangleMesh decode(const std::string& bytes) const {
    try {
      return decode_mesh(bytes);
    } catch (const Error& error) {
      throw ReaderLost{std::string("the answer of the program that reads meshes is not valid (") +
                       error.what() + ")" + kRemedy};
    }
  }

  // Throws ReaderLost if the exchange is not done.
  void need(Exchange exchange) {
    if (exchange == Exchange::done) return;
    if (stop_) throw Interrupted();
    if (exchange == Exchange::too_late)
      throw ReaderLost{"reading this mesh takes longer than " + text::brief(reading_.time) +
                           " s; simplify the mesh, or close other programs that load the machine",
                       false};
    const ChildEnding ending = child_->end();
    if (ending.signal == SIGXCPU)
      throw ReaderLost{
          "reading this mesh takes more than " + std::to_string(reading_.cpu_time) +
              " s of processor time. The file may be broken: export the mesh again, or simplify it",
          false};
    throw ReaderLost{"the program that reads meshes crashed on this file (" + ending.words() +
                     "). The file is damaged, or was made to cause a crash" + kRemedy};
  }

  // Sends the companion file of this name, or the message that there is none.
  void answer(const std::string& name) {
    if (asked_.size() == kMostMeshCompanions)
      throw ReaderLost{"the mesh file names more than " + std::to_string(kMostMeshCompanions) +
                       " other files; merge these files"};
    const std::optional<std::string> bytes = companion(name);
    asked_.push_back({name, bytes ? sha256(*bytes) : ""});
    const char there = 1;
    send_head(MeshMessage::file, bytes ? 1 + bytes->size() : 0);
    if (!bytes) return;
    need(child_->send(&there, 1));
    need(child_->send(bytes->data(), bytes->size()));
  }

  // A reader that a mesh has taken over may ask for any file. It only gets files that may belong to
  // a mesh.
  std::optional<std::string> companion(const std::string& name) {
    const fs::path relative = name;
    const std::string extension = lower_extension(relative);
    if (relative.is_absolute() || name.find('\0') != std::string::npos) return {};
    if (extension != ".mtl" && extension != ".bin") return {};
    const fs::path file = path_.parent_path() / relative;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return {};
    try {
      std::string bytes = read_file(file, kMostCompanionBytes - companion_bytes_);
      companion_bytes_ += bytes.size();
      return bytes;
    } catch (const Error& error) {
      complain(std::string("a file that the mesh names cannot be read: ") + error.what());
    }
  }

  // A path, or "data:" with the bytes of a picture inside the file.
  std::string texture_of(std::string texture) const {
    if (texture.empty()) return texture;
    const bool inside = texture[0] == kTextureBytes;
    texture.erase(0, 1);
    if (inside) return "data:" + texture;
    std::replace(texture.begin(), texture.end(), '\\', '/');
    if (texture.starts_with("file://")) texture.erase(0, 7);
    return (path_.parent_path() / texture).lexically_normal().string();
  }

  const MeshReading& reading_;
  const std::atomic<bool>& stop_;
  fs::path program_, path_;
  std::optional<ChildProcess> child_;
  MeshCache cache_;
  std::vector<AskedCompanion> asked_;  // for the present mesh
  size_t companion_bytes_ = 0;
};

/// Runs work() on another thread, while this thread calls `progress`. If `progress` throws, it sets
/// `stop`.
template <typename Work>
void watched(const Progress& progress, std::atomic<bool>& stop, const Work& work) {
  if (!progress) return work();
  std::future<void> done = std::async(std::launch::async, work);
  try {
    do report(progress, {"reading the meshes", -1, ""});
    while (done.wait_for(kPause) != std::future_status::ready);
  } catch (...) {
    stop = true;
    done.wait();
    throw;
  }
  done.get();
}

}  // namespace

TriangleMesh load_mesh(const fs::path& path, const Eigen::Vector3d& scale,
                       const MeshReading& reading) {
  const std::atomic<bool> never = false;
  return MeshReader(reading, never).read({path, scale});
}

std::vector<TriangleMesh> load_meshes(const std::vector<MeshRequest>& requests,
                                      MeshFailure& failure, const MeshReading& reading,
                                      const Progress& progress) {
  std::vector<TriangleMesh> meshes(requests.size());
  const size_t groups = std::min(kMeshReaders, requests.size());
  std::vector<MeshFailure> failures(groups);
  std::atomic<bool> stop = false, failed = false;
  // The choice of the reader for each mesh does not depend on the machine. The first failure of
  // each group is known, so that the first failure of all is known, too.
  const auto read_group = [&](size_t group) {
    size_t i = group;
    try {
      MeshReader reader(reading, stop);
      for (; i < requests.size() && !stop; i += groups) meshes[i] = reader.read(requests[i]);
    } catch (const Error&) {
      failures[group] = {i, std::current_exception()};
    }
  };
  watched(progress, stop,
          [&] { in_parallel(groups, static_cast<int>(groups), failed, read_group); });
  failure = {};
  for (const MeshFailure& candidate : failures)
    if (candidate.error && (!failure.error || candidate.request < failure.request))
      failure = candidate;
  if (failure.error)
    for (size_t i = failure.request; i < meshes.size(); ++i) meshes[i] = {};
  return meshes;
}

}  // namespace ayumi
