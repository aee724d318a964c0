#include "connection.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace ayumi::mesh_reader {

namespace {

constexpr int kSocket = STDIN_FILENO;

void send_all(const char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t sent = ::send(kSocket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) _exit(0);
    bytes += sent;
    size -= static_cast<size_t>(sent);
  }
}

void receive_all(char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t got = recv(kSocket, bytes, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) _exit(0);
    bytes += got;
    size -= static_cast<size_t>(got);
  }
}

void send_head(MeshMessage kind, std::uint64_t size) {
  const MeshMessageHead head{kind, 0, size};
  send_all(reinterpret_cast<const char*>(&head), sizeof head);
}

}  // namespace

void send(MeshMessage kind, std::string_view bytes) {
  send_head(kind, bytes.size());
  send_all(bytes.data(), bytes.size());
}

void send_hello() { send_head(MeshMessage::hello, kMeshMessageVersion); }

std::string receive(MeshMessage kind) {
  MeshMessageHead head;
  receive_all(reinterpret_cast<char*>(&head), sizeof head);
  if (head.kind != kind) _exit(1);
  std::string bytes(head.size, '\0');
  receive_all(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace ayumi::mesh_reader
