// HTTP requests of the live page: the head of the request, then its body. The requests go through
// the library that parses HTTP, the checks of the secret, Host and Origin, and the session of a
// pattern in a folder of its own, but through no socket. The pattern is put back after each input,
// so that inputs do not depend on those before them.

#include <httplib.h>

#include "author/author_requests.hpp"
#include "ayumi/base/file.hpp"
#include "fuzz_target.hpp"
#include "requests_seed.hpp"

namespace {

using namespace ayumi;
using fuzz::kSecret;

/// A client that has sent its whole request. It closes the connection after the first event for a
/// page that listens.
class Client : public httplib::Stream {
 public:
  explicit Client(std::string request) : request_(std::move(request)) {}
  const std::string& answer() const { return answer_; }

  bool is_readable() const override { return true; }
  bool is_writable() const override { return answer_.find("retry: 500") == std::string::npos; }
  ssize_t read(char* to, size_t size) override {
    const size_t count = request_.copy(to, size, at_);
    at_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, size_t size) override {
    answer_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& address, int& port) const override {
    address = app::kLoopbackAddress;
    port = fuzz::kPort + 1;
  }
  void get_local_ip_and_port(std::string& address, int& port) const override {
    address = app::kLoopbackAddress;
    port = fuzz::kPort;
  }
  ::socket_t socket() const override { return -1; }

 private:
  std::string request_, answer_;
  size_t at_ = 0;
};

/// The server of `ayumi author` without its socket.
class Page : public httplib::Server {
 public:
  Page()
      : folder_({{"", fuzz::kAuthored}}, "stand.json"),
        session_(context(), {folder_.path("stand.json"), {}, ""}),
        requests_(session_, kSecret, fuzz::kPort) {
    requests_.set_up(*this);
  }

  std::string answer(const std::string& request) {
    Client client(request);
    bool closed = false;
    process_request(client, true, closed, nullptr);
    return client.answer();
  }
  app::OrderedJson state() { return app::OrderedJson::parse(session_.state()); }

  /// Resets the pattern to that of the seeds, with no job running.
  void put_back() {
    const app::OrderedJson now = state();
    if (now["text"] != fuzz::kAuthored) {
      const auto answer = session_.edit({{"hash", now["hash"]}, {"text", fuzz::kAuthored}});
      fuzz::expect(answer.status == 200, "a pattern can be put back");
    }
    fuzz::expect(state()["error"].is_null(), "the pattern that was put back can be read");
  }
  void end_job(const std::string& id) { session_.cancel_job(id); }

 private:
  static const app::Context& context() {
    static const app::Context context = [] {
      app::Context made;
      made.quiet = true;
      made.threads = 1;
      made.robot_path = {AYUMI_SOURCE_DIR "/robots"};
      return made;
    }();
    return context;
  }

  fuzz::InputFolder folder_;
  app::AuthorSession session_;
  app::AuthorRequests requests_;
};

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

/// The request with lines that end as HTTP requires, and with the length of the body.
std::string request_of(const std::vector<fuzz::Part>& parts) {
  std::string head = parts[0].bytes;
  const std::string body = parts.size() > 1 ? parts[1].bytes : "";
  replace_all(head, fuzz::kLengthOfBody, std::to_string(body.size()));
  std::string request;
  for (const char c : head) request += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return request + "\r\n" + body;
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Page page;
  const auto parts = fuzz::parts_of({reinterpret_cast<const char*>(data), size});
  const std::string request = request_of(parts);
  std::string answer = page.answer(request);
  // "Expect: 100-continue" is answered separately before the actual answer.
  if (answer.starts_with("HTTP/1.1 100 ")) answer.erase(0, answer.find("\r\n\r\n") + 4);
  if (answer.empty()) return 0;  // the head of the request was not complete
  fuzz::expect(answer.starts_with("HTTP/1.1 "), "an answer is one of HTTP");
  const std::string status = answer.substr(9, 3);
  fuzz::expect(status != "500", "the server can answer every request");
  const bool done = status[0] == '2';
  // The path may be written with %30 and similar codes.
  fuzz::expect(!done || has(request, kSecret) || has(request, "%"),
               "only who knows the secret asks");
  const std::string port = ":" + std::to_string(fuzz::kPort);
  fuzz::expect(
      !done || has(request, app::kLoopbackAddress + port) || has(request, "localhost" + port),
      "only who names the address in Host asks");
  const size_t body = answer.find("\r\n\r\n");
  if (done && body != std::string::npos && has(answer, "\"id\":"))
    if (const auto json = app::OrderedJson::parse(answer.substr(body + 4), nullptr, false);
        json.is_object() && json.contains("id") && json["id"].is_string())
      page.end_job(json["id"].get<std::string>());
  if (!done) {
    fuzz::expect(page.state()["text"] == fuzz::kAuthored, "a refused request changes nothing");
    return 0;
  }
  page.put_back();
  return 0;
}
