#pragma once
// The connection to Ayumi on standard input, which carries the messages of
// ayumi/io/robot/mesh_message.hpp.

#include <string>
#include <string_view>

#include "ayumi/io/robot/mesh_message.hpp"

namespace ayumi::mesh_reader {

/// Sends a message. Ends the process if Ayumi has closed the connection.
void send(MeshMessage kind, std::string_view bytes);
/// Sends the message `hello` with the version of the messages.
void send_hello();
/// Returns the bytes of the next message. Ends the process with exit code 0 if there is no message,
/// and with exit code 1 if the message is of another kind.
std::string receive(MeshMessage kind);

}  // namespace ayumi::mesh_reader
