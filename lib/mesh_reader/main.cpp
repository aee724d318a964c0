// Reads mesh files for Ayumi, which starts this program. The bytes of a file come in, and triangles
// go out, over the connection on standard input. The program runs with limits, so that a broken or
// hostile file can at worst end this process.

#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <new>

#include "confinement.hpp"
#include "connection.hpp"
#include "mesh_import.hpp"

namespace {

using namespace ayumi;
using namespace ayumi::mesh_reader;

// assimp turns bad_alloc into a text; this variable remembers that it happened.
bool memory_is_over = false;

void on_no_memory() {
  memory_is_over = true;
  throw std::bad_alloc();
}

bool started_by_ayumi() {
  int type = 0;
  socklen_t size = sizeof type;
  return getsockopt(STDIN_FILENO, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_STREAM;
}

void serve(std::string request) {
  MeshRequestHead about;
  if (request.size() < sizeof about) _exit(1);
  std::memcpy(&about, request.data(), sizeof about);
  if (about.name_size > request.size() - sizeof about) _exit(1);
  const std::string name = request.substr(sizeof about, about.name_size);
  request.erase(0, sizeof about + about.name_size);
  const std::string& bytes = request;
  limit(about.base_memory + about.memory_per_byte * bytes.size(), about.cpu_time);
  memory_is_over = false;
  std::string answer;
  MeshMessage kind = MeshMessage::mesh;
  try {
    const AskFile ask = [&](const std::string& path) -> std::optional<std::string> {
      send(MeshMessage::ask, path);
      const std::string file = receive(MeshMessage::file);
      if (file.empty()) return {};
      allow_more_memory(about.memory_per_byte * file.size());
      return file.substr(1);
    };
    answer = encode_mesh(
        import_mesh(name, bytes, {about.scale[0], about.scale[1], about.scale[2]}, ask));
  } catch (const Refusal& refusal) {
    kind = MeshMessage::refusal;
    answer = refusal.what();
  } catch (const std::bad_alloc&) {
    memory_is_over = true;
  }
  if (memory_is_over && kind == MeshMessage::refusal) kind = MeshMessage::memory;
  if (memory_is_over && answer.empty()) kind = MeshMessage::memory;
  send(kind, kind == MeshMessage::memory ? "" : answer);
}

}  // namespace

int main() {
  if (!started_by_ayumi()) {
    std::fputs("ayumi-mesh-reader: Ayumi starts this program itself to read meshes\n", stderr);
    return 2;
  }
  std::set_new_handler(on_no_memory);
  confine();
  send_hello();
  while (true) serve(receive(MeshMessage::request));
}
