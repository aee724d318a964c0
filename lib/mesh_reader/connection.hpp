#pragma once
// The connection to Ayumi on standard input, which carries the messages of
// ayumi/io/robot/mesh_message.hpp.

#include <string>
#include <string_view>

#include "ayumi/io/robot/mesh_message.hpp"

namespace ayumi::mesh_reader {

/// Sends a message. It ends the process if Ayumi has closed the connection.
void send(MeshMessage kind, std::string_view bytes);
/// Sends the number that a hello has.
void send_hello();
/// Returns the bytes of the next message. It ends the process if there is none, with exit code 0,
/// or if it is of another kind, with exit code 1.
std::string receive(MeshMessage kind);

}  // namespace ayumi::mesh_reader
