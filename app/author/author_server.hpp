#pragma once
// The server of the live page: on the loopback address alone, for requests that know its secret.

#include <functional>
#include <string>

#include "author/author_session.hpp"

namespace ayumi::app {

struct ServerOptions {
  int port = 0;  ///< 0: any that is free
};

/// Serves until `stopped` says so; a client that holds a connection without a word keeps the
/// function for two seconds more. `ready` receives the address with the secret. Throws
/// Error(bad_file) where the port is taken.
void serve_author(AuthorSession& session, const ServerOptions& options,
                  const std::function<void(const std::string& address)>& ready,
                  const std::function<bool()>& stopped);

}  // namespace ayumi::app
