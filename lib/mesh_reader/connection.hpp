#pragma once
// The connection to Ayumi, on standard input: messages of ayumi/io/robot/mesh_message.hpp.

#include <string>
#include <string_view>

#include "ayumi/io/robot/mesh_message.hpp"

namespace ayumi::mesh_reader {

/// Ends the process where Ayumi has closed the connection.
void send(MeshMessage kind, std::string_view bytes);
/// The number that a hello has.
void send_hello();
/// The bytes of the next message. Ends the process where there is none, with exit code 0, or where
/// it is of another kind, with exit code 1.
std::string receive(MeshMessage kind);

}  // namespace ayumi::mesh_reader
