#include "author/author_server.hpp"

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <thread>

#include "author/author_requests.hpp"
#include "ayumi/base/error.hpp"

namespace ayumi::app {

namespace {

using namespace std::chrono_literals;

// A secret of 128 random bits, which nobody can guess.
std::string secret() {
  std::random_device random;
  const char* const digits = "0123456789abcdef";
  std::string word;
  for (int i = 0; i < 32; ++i) word += digits[random() % 16];
  return word;
}

}  // namespace

void serve_author(AuthorSession& session, const ServerOptions& options,
                  const std::function<void(const std::string&)>& ready,
                  const std::function<bool()>& stopped) {
  auto server = std::make_unique<httplib::Server>();
  // Only this server may use the port; by default, the library would share it with other processes.
  server->set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  int port = options.port;
  const bool bound = port > 0 ? server->bind_to_port(kLoopbackAddress, port)
                              : (port = server->bind_to_any_port(kLoopbackAddress)) > 0;
  if (!bound)
    fail(ErrorCode::bad_file, options.port > 0
                                  ? "port " + std::to_string(options.port) +
                                        " is taken. Choose another --port, or leave --port out"
                                  : std::string("no port is free on the loopback address"));
  const std::string token = secret();
  AuthorRequests requests(session, token, port);
  requests.set_up(*server);
  std::atomic<bool> ended = false;
  std::thread listening([&] {
    server->listen_after_bind();
    ended = true;
  });
  // A server only reacts to stop() when it is running.
  while (!server->is_running() && !ended) std::this_thread::sleep_for(1ms);
  ready(std::string("http://") + kLoopbackAddress + ":" + std::to_string(port) + "/" + token + "/");
  while (!stopped() && !ended) std::this_thread::sleep_for(50ms);
  session.stop();
  requests.stop();
  server->stop();
  listening.join();
}

}  // namespace ayumi::app
