#include "author/author_requests.hpp"

#include <httplib.h>

#include <atomic>
#include <map>

#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/report/page.hpp"

namespace ayumi::app {

namespace {

using httplib::Request;
using httplib::Response;

// Largest number of pages that listen at one time, and number of threads for them and for requests.
// Chosen: more pages than one person opens; each listening page occupies a thread.
constexpr int kListeners = 24, kThreads = 32;
// Time in which a client has to send the next bytes of its request [s].
constexpr time_t kRequestPatience = 2;

// Compares secrets in a time that does not depend on their content.
bool equal_secrets(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

// Sends the bytes as they are. set_content() would compress them by Brotli at its highest level if
// the browser accepts that, and this takes longer than sending them within one machine.
void send(Response& response, std::string bytes, const char* type) {
  if (bytes.empty()) return response.set_content(bytes, type);
  const auto held = std::make_shared<const std::string>(std::move(bytes));
  response.set_content_provider(held->size(), type,
                                [held](size_t begin, size_t length, httplib::DataSink& sink) {
                                  return sink.write(held->data() + begin, length);
                                });
}

void set_json(Response& response, const AuthorAnswer& answer) {
  response.status = answer.status;
  send(response, answer.body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
       "application/json");
}

void set_limits(httplib::Server& server) {
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_keep_alive_max_count(1);
  server.set_payload_max_length(kLargestPattern);
  server.set_read_timeout(kRequestPatience);
  server.set_write_timeout(kRequestPatience);
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"}});
}

}  // namespace

class AuthorRequests::Router {
 public:
  Router(AuthorSession& session, std::string token, int port)
      : session_(session), token_(std::move(token)), port_(std::to_string(port)) {}

  /// Whether the request comes from a page of this server: it knows the secret, and the browser
  /// does not say that a page of another origin made it.
  bool allows(const Request& request) const {
    // Of two headers of one name, only the first would be read.
    if (request.get_header_value_count("Host") > 1 || request.get_header_value_count("Origin") > 1)
      return false;
    const std::string host = request.get_header_value("Host");
    if (host != kLoopbackAddress + (":" + port_) && host != "localhost:" + port_) return false;
    if (request.has_header("Origin")) {
      const std::string origin = request.get_header_value("Origin");
      if (origin != "http://" + host) return false;
    }
    const size_t end = request.path.find('/', 1);
    return end != std::string::npos && equal_secrets(request.path.substr(1, end - 1), token_);
  }

  void get(const Request& request, Response& response) {
    const std::string path = inside(request);
    if (path.empty()) {
      send(response, std::string(kAuthorPage), "text/html; charset=utf-8");
    } else if (path == "state") {
      send(response, session_.state(), "application/json");
    } else if (path == "model.glb") {
      send(response, session_.model(), "model/gltf-binary");
    } else if (path == "scenery") {
      send(response, session_.scenery(), "application/octet-stream");
    } else if (path == "series") {
      const auto bytes = session_.series(request.get_param_value("which"));
      if (bytes)
        send(response, *bytes, "application/octet-stream");
      else
        response.status = 404;
    } else if (path == "events") {
      listen(response);
    } else {
      response.status = 404;
    }
  }

  void post(const Request& request, Response& response) {
    const auto body = shallow_json<OrderedJson>(request.body);
    if (!body.is_object())
      return set_json(
          response,
          {400, {{"message", "the request is not a JSON object, or it is nested too deeply"}}});
    const std::string path = inside(request);
    using Handler = AuthorAnswer (AuthorSession::*)(const OrderedJson&);
    static const std::map<std::string, Handler> handlers = {
        {"edit", &AuthorSession::edit},       {"undo", &AuthorSession::undo},
        {"redo", &AuthorSession::redo},       {"pose", &AuthorSession::pose},
        {"posture", &AuthorSession::posture}, {"mirror", &AuthorSession::mirror},
        {"job", &AuthorSession::start_job}};
    const auto found = handlers.find(path);
    if (found == handlers.end())
      response.status = 404;
    else
      set_json(response, (session_.*found->second)(body));
  }

  void remove(const Request& request, Response& response) {
    const std::string path = inside(request);
    if (path.starts_with("job/"))
      set_json(response, session_.cancel_job(path.substr(4)));
    else
      response.status = 404;
  }

  void stop() { stopping_ = true; }

 private:
  std::string inside(const Request& request) const {
    return request.path.substr(request.path.find('/', 1) + 1);
  }

  void listen(Response& response) {
    if (++listeners_ > kListeners) {
      --listeners_;
      response.status = 503;
      return;
    }
    auto next = std::make_shared<std::uint64_t>(session_.next_event());
    auto first = std::make_shared<bool>(true);
    auto quiet = std::make_shared<int>(0);
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, next, first, quiet](size_t, httplib::DataSink& sink) {
          if (stopping_) return false;
          std::string words;
          if (*first) words = "retry: 500\n\n";
          *first = false;
          if (words.empty()) {
            if (const auto event = session_.wait_for_event(*next)) {
              ++*next;
              *quiet = 0;
              words = "event: " + event->name + "\ndata: " + event->data + "\n\n";
            } else if (++*quiet % 10 == 0) {
              words = ": nothing new\n\n";  // so that the server notices when a page has gone
            }
          }
          if (stopping_) return false;
          return words.empty() ? sink.is_writable() : sink.write(words.data(), words.size());
        },
        [this](bool) { --listeners_; });
  }

  AuthorSession& session_;
  std::string token_, port_;
  std::atomic<int> listeners_ = 0;
  std::atomic<bool> stopping_ = false;
};

AuthorRequests::AuthorRequests(AuthorSession& session, const std::string& token, int port)
    : router_(std::make_unique<Router>(session, token, port)) {}

AuthorRequests::~AuthorRequests() = default;

void AuthorRequests::set_up(httplib::Server& server) {
  set_limits(server);
  Router* const router = router_.get();
  server.set_pre_routing_handler([router](const Request& request, Response& response) {
    if (router->allows(request)) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
  server.set_exception_handler([](const Request&, Response& response, std::exception_ptr) {
    set_json(response,
             {500, {{"message", "the server could not answer this request; reload the page"}}});
  });
  server.Get(".*", [router](const auto& q, auto& a) { router->get(q, a); });
  server.Post(".*", [router](const auto& q, auto& a) { router->post(q, a); });
  server.Delete(".*", [router](const auto& q, auto& a) { router->remove(q, a); });
}

void AuthorRequests::stop() { router_->stop(); }

}  // namespace ayumi::app
