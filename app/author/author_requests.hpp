#pragma once
// The requests of the live page: who may ask, how large a request may be, and what answers it. They
// do not depend on the socket, so that tests/fuzz can test them without one.

#include <memory>
#include <string>

#include "author/author_session.hpp"

namespace httplib {
class Server;
}

namespace ayumi::app {

inline constexpr const char* kLoopbackAddress = "127.0.0.1";

class AuthorRequests {
 public:
  /// Answers requests for the address http://127.0.0.1:port/token/. `session` must outlive the
  /// object.
  AuthorRequests(AuthorSession& session, const std::string& token, int port);
  ~AuthorRequests();
  AuthorRequests(const AuthorRequests&) = delete;
  AuthorRequests& operator=(const AuthorRequests&) = delete;

  /// Sets the limits, handlers and headers of the server. The server must not outlive the object.
  void set_up(httplib::Server& server);
  /// Ends the requests of the pages that listen.
  void stop();

 private:
  class Router;
  std::unique_ptr<Router> router_;
};

}  // namespace ayumi::app
