#pragma once
// The server of the live page. It only listens on the loopback address, and only answers requests
// that contain its secret.

#include <functional>
#include <string>

#include "author/author_session.hpp"

namespace ayumi::app {

struct ServerOptions {
  int port = 0;  ///< number of the port; 0: any free one
};

/// Serves until `stopped` returns true. If a client keeps a connection without sending anything,
/// the function takes two seconds more. `ready` receives the address with the secret. Throws
/// Error(bad_file) if the port is taken.
void serve_author(AuthorSession& session, const ServerOptions& options,
                  const std::function<void(const std::string& address)>& ready,
                  const std::function<bool()>& stopped);

}  // namespace ayumi::app
