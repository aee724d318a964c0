// The server of `ayumi author`, asked as its page asks it.
#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <random>
#include <thread>

#include "ayumi/base/file.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

// Longest time that the server may take for anything here [s]. Chosen: a hundred times what it
// needs.
constexpr int kServerPatience = 60;

class Server {
 public:
  explicit Server(const fs::path& pattern, const std::vector<std::string>& more = {}) {
    std::array<int, 2> out{};
    if (::pipe(out.data()) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::alarm(5 * kServerPatience);  // in case the test is killed
      ::dup2(out[1], STDOUT_FILENO);
      ::close(out[0]);
      ::close(out[1]);
      std::vector<std::string> words = {program_under_test(), "author", pattern.string(), "--json"};
      words.insert(words.end(), more.begin(), more.end());
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(out[1]);
    std::string said;
    char letter = 0;
    while (::read(out[0], &letter, 1) == 1 && letter != '\n') said += letter;
    ::close(out[0]);
    const std::string address = json_or_nothing(said).value("address", "");
    const size_t colon = address.rfind(':'), slash = address.find('/', colon);
    if (slash == std::string::npos) return;
    port_ = std::stoi(address.substr(colon + 1));
    root_ = address.substr(slash);
  }
  ~Server() {
    if (process_ > 0 && !ended_) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return port_; }
  const std::string& root() const { return root_; }

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(kServerPatience);
    return client;
  }
  std::string get(const std::string& path) const {
    const auto answer = client().Get(root_ + path);
    return answer && answer->status == 200 ? answer->body : "";
  }
  Json state() const { return json_of(get("state")); }
  std::pair<int, Json> post(const std::string& path, const Json& body) const {
    const auto answer = client().Post(root_ + path, body.dump(), "application/json");
    if (!answer) return {0, {}};
    return {answer->status, json_or_nothing(answer->body)};
  }
  std::pair<int, Json> edit(const Json& edits) const {
    return post("edit", {{"hash", state()["hash"]}, {"edits", edits}});
  }
  /// Waits for a state for which `holds` returns true.
  template <typename Holds>
  Json state_when(const Holds& holds) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kServerPatience);
    Json now = state();
    while (!holds(now) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(10ms);
      now = state();
    }
    return now;
  }
  /// The seconds from Ctrl-C to the end, and the exit code. Before Ctrl-C, the process rests for
  /// `held`.
  std::pair<double, int> interrupt(std::chrono::milliseconds held = 0ms) {
    const auto begin = std::chrono::steady_clock::now();
    ::kill(process_, SIGINT);
    if (held > 0ms) {
      std::this_thread::sleep_for(10ms);  // it hears of Ctrl-C before anything else
      ::kill(process_, SIGSTOP);
      std::this_thread::sleep_for(held);
      ::kill(process_, SIGCONT);
    }
    int status = 0;
    ::waitpid(process_, &status, 0);
    ended_ = true;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    return {took.count(), WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
  }

 private:
  pid_t process_ = -1;
  bool ended_ = false;
  int port_ = 0;
  std::string root_;
};

/// The edit that sets one value.
Json set(const std::string& pointer, const Json& value) {
  return {{{"kind", "set"}, {"pointer", pointer}, {"value", value}}};
}

/// A connection on which nothing is sent.
class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to = {};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

 private:
  int socket_;
};

struct AuthorServer : testing::Test {
  void SetUp() override {
    const Output said = run_program({"author", "nothing.json"}, folder.path());
    if (said.err.find("built without npm") != std::string::npos)
      GTEST_SKIP() << "built without npm: there is no page to serve";
    walk = contents(kWalk);
    file = folder / "walk.json";
    save(walk);
  }
  void save(const std::string& text) const {
    write(folder / "walk.json.new", text);
    fs::rename(folder / "walk.json.new", file);
  }
  /// A walk of one step instead of the bundled one, for many edits, because the motion is judged
  /// after each.
  void shorten() {
    const Output made = run_program(
        {"new", "walk", "--steps", "1", "-q", "--force", "-o", file.string()}, folder.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    walk = contents(file);
  }
  std::string replaced(const std::string& what, const std::string& by) const {
    std::string text = walk;
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  }

  Folder folder;
  fs::path file;
  std::string walk;
};

TEST_F(AuthorServer, AnswersOnlyItsOwnPage) {
  const Server server(file);
  httplib::Client client = server.client();
  const auto status = [&](const std::string& path, const httplib::Headers& headers = {}) {
    const auto answer = client.Get(path, headers);
    return answer ? answer->status : 0;
  };
  const std::string state = server.root() + "state",
                    own = "http://127.0.0.1:" + std::to_string(server.port());
  EXPECT_EQ(status(state), 200);
  EXPECT_EQ(status(state, {{"Origin", own}}), 200);
  EXPECT_EQ(status("/"), 403);
  EXPECT_EQ(status("/state"), 403);
  EXPECT_EQ(status("/0123456789abcdef0123456789abcdef/state"), 403);
  EXPECT_EQ(status(state, {{"Origin", "http://example.org"}}), 403);
  EXPECT_EQ(status(state, {{"Origin", "null"}}), 403);
  EXPECT_EQ(status(state, {{"Host", "example.org"}}), 403);
  EXPECT_EQ(status(state, {{"Host", "example.org:" + std::to_string(server.port())}}), 403);
  EXPECT_EQ(status(state, {{"Origin", own}, {"Origin", "http://example.org"}}), 403);
  const std::string host = own.substr(own.find("127"));
  EXPECT_EQ(status(state, {{"Host", host}, {"Host", "example.org"}}), 403);
  for (const char* const path : {"nothing", "../walk.json", "walk.json", "%2e%2e/%2e%2e/etc/passwd",
                                 "series?which=/etc/passwd", "series"})
    EXPECT_NE(status(server.root() + path), 200) << path;
  const auto page = client.Get(server.root());
  ASSERT_TRUE(page);
  EXPECT_NE(page->body.find("<html"), std::string::npos);
  EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
  // A request that is not an edit is refused, and the file stays as it is.
  for (const char* const body : {"", "[]", "{", "{\"hash\":3}", "{\"hash\":\"\",\"edits\":7}"})
    EXPECT_GE(client.Post(server.root() + "edit", body, "application/json")->status, 400) << body;
  EXPECT_EQ(contents(file), walk);
  EXPECT_NE(client.Put(server.root() + "state", "", "text/plain")->status, 200);
}

// In an earlier version, compressing by Brotli at its highest level took longer than the change of
// the motion itself.
TEST_F(AuthorServer, CompressesNothing) {
  const Server server(file);
  httplib::Client client = server.client();
  for (const char* const path : {"", "state", "model.glb"}) {
    const auto answer = client.Get(server.root() + path,
                                   httplib::Headers{{"Accept-Encoding", "gzip, deflate, br"}});
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 200) << path;
    EXPECT_FALSE(answer->has_header("Content-Encoding")) << path;
    EXPECT_EQ(answer->get_header_value("Content-Length"), std::to_string(answer->body.size()))
        << path;
  }
}

// In an earlier version, such a request ended the server: its value was written by recursion.
TEST_F(AuthorServer, RefusesRequestsThatAreNestedDeeply) {
  const Server server(file);
  const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
  const std::string hash = server.state()["hash"];
  for (const auto& [path, body] :
       {std::pair<std::string, std::string>(
            "edit", R"({"hash": ")" + hash +
                        R"(", "edits": [{"kind": "set", "pointer": "/name", "value": )" + deep +
                        "}]}"),
        {"job", R"({"kind": "simulate", "options": )" + deep + "}"}}) {
    const auto answer = server.client().Post(server.root() + path, body, "application/json");
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 400) << answer->body;
  }
  EXPECT_EQ(server.state()["hash"], hash);
}

TEST_F(AuthorServer, FollowsTheFileAndNamesTheLineOfAnError) {
  const Server server(file);
  EXPECT_TRUE(server.state()["consistent"].get<bool>());
  save(replaced(R"({ "t": 3.771, "zmp": "left" })", R"({ "t": 3.771, "zmp": [0.12, 0.085] })"));
  Json state = server.state_when([](const Json& now) { return now["consistent"] == false; });
  ASSERT_FALSE(state["findings"].empty());
  EXPECT_NE(server.get("series?which=ghost"), "") << "the last consistent motion";
  EXPECT_EQ(server.get("series?which=ghost").size(), server.get("series?which=plan").size());
  const int line = 10;  // line of "phases" in the file
  struct Case {
    std::string what, by, message;
    int line;
  };
  const std::vector<Case> cases = {
      {"\"phases\"", "phases", "", line},
      {R"("until": 1.571)", R"("until": "late")", "late", line + 2},
      {R"({ "t": 1.571, "zmp": "left" })", R"({ "t": 1.571, "zmp": "middle" })", "middle", 35},
      {R"({ "t": 1.571, "zmp": "left" })", R"({ "t": 1.571, "joints": { "elbow": 3 } })", "elbow",
       35},
      {R"("to": [0.03, -0.039])", R"("to": [0.4, -0.039])", "out of reach", line + 2}};
  const std::string old = server.get("series?which=plan");
  for (const Case& each : cases) {
    save(replaced(each.what, each.by));
    state = server.state_when(
        [&](const Json& now) { return now["text"] == replaced(each.what, each.by); });
    ASSERT_FALSE(state["error"].is_null()) << each.by;
    EXPECT_TRUE(state["stale"].get<bool>());
    EXPECT_NE(state["error"]["message"].get<std::string>().find(each.message), std::string::npos);
    EXPECT_EQ(state["error"].value("line", 0), each.line) << state["error"].dump();
    EXPECT_EQ(server.get("series?which=plan"), old) << "the old motion is still there";
  }
  save(walk);
  state = server.state_when([](const Json& now) { return now["error"].is_null(); });
  EXPECT_TRUE(state["consistent"].get<bool>());
}

// The message begins with the likely cause, so the line is that of the cause, and not that of the
// phase in which the legs fail.
TEST_F(AuthorServer, AnErrorWithALikelyCauseIsAtTheLineOfTheCause) {
  const Server server(file);
  const std::string kick = R"({
  "format": "ayumi.pattern/1", "robot": "hoap1", "units": { "angle": "deg" },
  "phases": [
    { "until": 1.2, "support": "both" },
    { "until": 2.8, "support": "right" },
    { "until": 4, "support": "both" }
  ],
  "keyframes": [
    { "t": 0.6, "zmp": "center" },
    { "t": 1.1, "zmp": "right" },
    { "t": 1.2, "feet": { "left": [0, 0.039, 0] } },
    { "t": 2.1, "feet": { "left": [0, 0.039, 0.05] } },
    { "t": 2.8, "feet": { "left": [0, 0.039, 0] } },
    { "t": 2.9, "zmp": "right" },
    { "t": 3.5, "zmp": "center" }
  ]
}
)";
  save(kick);
  const Json error =
      server.state_when([&](const Json& now) { return now["text"] == kick; })["error"];
  ASSERT_FALSE(error.is_null());
  EXPECT_TRUE(error["message"].get<std::string>().starts_with("likely cause: /keyframes/3: "))
      << error;
  EXPECT_EQ(error.value("line", 0), 12) << error;
}

TEST_F(AuthorServer, AnErrorOfTheWholeFileHasNoLine) {
  const Server server(file);
  const std::string without = R"({ "format": "ayumi.pattern/1", "robot": "hoap1" })";
  save(without);
  const Json state = server.state_when([&](const Json& now) { return now["text"] == without; });
  ASSERT_FALSE(state["error"].is_null());
  EXPECT_FALSE(state["error"].contains("line")) << state["error"].dump();
}

TEST_F(AuthorServer, GoesOnAfterATextThatIsNoJson) {
  const Server server(file);
  const std::string good = contents(file), broken = replaced("\"phases\"", "phases");
  const auto shown = [&](const std::string& text) {
    save(text);
    return server.state_when([&](const Json& now) { return now["text"] == text; });
  };
  const auto line = 1 + std::count(good.begin(), good.begin() + good.find("\"phases\""), '\n');
  EXPECT_EQ(shown(broken)["error"]["line"], line);
  for (const char* const text : {"", "x", "{", "[]", "{} {}"})
    EXPECT_FALSE(shown(text)["error"].is_null()) << text;
  EXPECT_TRUE(shown(good)["error"].is_null());
}

TEST_F(AuthorServer, ShowsTheLastOfManyQuickSaves) {
  const Server server(file);
  std::string last;
  for (int i = 0; i < 100; ++i) {
    last = replaced("hoap1_walk", "save_" + std::to_string(i));
    if (i % 2)
      save(last);
    else
      write(file, last);  // the file is written in place, as some editors do
    std::this_thread::sleep_for(3ms);
  }
  EXPECT_EQ(server.state_when([&](const Json& now) { return now["text"] == last; })["text"], last);
}

// An editor may empty the file and write it a moment later. The empty text is not shown, and Undo
// does not lead back to it.
TEST_F(AuthorServer, AFileThatIsWrittenInStepsIsReadWhenItIsWhole) {
  const Server server(file);
  for (int i = 0; i < 5; ++i) {
    const std::string text = replaced("hoap1_walk", "save_" + std::to_string(i));
    write(file, "");
    std::this_thread::sleep_for(30ms);
    write(file, text.substr(0, 300));
    std::this_thread::sleep_for(30ms);
    write(file, text);
    const Json state = server.state_when([&](const Json& now) { return now["text"] == text; });
    EXPECT_EQ(state["undo"], i + 1) << "one step for each save";
  }
}

TEST_F(AuthorServer, WritesEditsIntoTheTextAndTakesThemBack) {
  shorten();
  const Server server(file);
  const Json edits = {{{"kind", "set"}, {"pointer", "/keyframes/1/t"}, {"value", 0.75}}};
  ASSERT_EQ(server.edit(edits).first, 200);
  EXPECT_EQ(contents(file), replaced("\"t\": 0.71", "\"t\": 0.75"));
  EXPECT_EQ(server.state()["keyframes"][1]["time"], 0.75);
  for (int i = 0; i < 40; ++i)
    ASSERT_EQ(
        server.edit({{{"kind", "set"}, {"pointer", "/keyframes/1/t"}, {"value", 0.5 + 0.005 * i}}})
            .first,
        200);
  EXPECT_EQ(server.state()["undo"], 41);
  for (int i = 0; i < 41; ++i)
    ASSERT_EQ(server.post("undo", {{"hash", server.state()["hash"]}}).first, 200);
  EXPECT_EQ(contents(file), walk);
  EXPECT_EQ(server.post("undo", {{"hash", server.state()["hash"]}}).first, 422);
  ASSERT_EQ(server.post("redo", {{"hash", server.state()["hash"]}}).first, 200);
  EXPECT_EQ(contents(file), replaced("\"t\": 0.71", "\"t\": 0.75"));
  EXPECT_EQ(server.edit({{{"kind", "remove"}, {"pointer", "/keyframes/99"}}}).first, 422);
  EXPECT_EQ(contents(file), replaced("\"t\": 0.71", "\"t\": 0.75"));
}

TEST_F(AuthorServer, AfterEditsItShowsWhatAServerShowsThatStartsAnew) {
  shorten();
  const Server server(file);
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::round(1e4 * (low + (high - low) * static_cast<double>(random()) / 4294967295.0)) /
           1e4;
  };
  for (int i = 0; i < 8; ++i) {
    const Json edits = i % 4 == 0   ? set("/keyframes/1/t", between(0.5, 0.7))
                       : i % 4 == 1 ? set("/defaults/cog_height", between(0.2, 0.225))
                       : i % 4 == 2 ? set("/world/friction", between(0.02, 0.8))
                                    : set("/keyframes/1/joints/r_shoulder_pitch", between(60, 120));
    ASSERT_EQ(server.edit(edits).first, 200) << edits.dump();
    const Server anew(file);
    const Json now = server.state(), expected = anew.state();
    ASSERT_TRUE(expected["error"].is_null()) << expected["error"].dump();
    for (const char* const part :
         {"text", "consistent", "reason", "findings", "groups", "tracks", "phases"})
      EXPECT_EQ(now[part].dump(), expected[part].dump()) << part << " after " << edits.dump();
    EXPECT_EQ(now["strips"]["plan"].dump(), expected["strips"]["plan"].dump());
    EXPECT_EQ(server.get("series?which=plan"), anew.get("series?which=plan"));
  }
}

// What the page shows is computed with the parameters of the command line, and so is the text that
// it writes.
TEST_F(AuthorServer, EditsExpressionsWithTheParametersOfTheCommand) {
  const std::string text = R"({
  "format": "ayumi.pattern/1", "robot": "hoap1", "units": { "angle": "deg" },
  "parameters": { "down": 1.2, "side": 0.045 },
  "phases": [
    { "until": 1.4, "support": "both" },
    { "until": 1.9, "support": "right", "swing": { "foot": "left", "to": [0, "${side}"] } },
    { "until": 4, "support": "both" }
  ],
  "keyframes": [
    { "t": 0.4, "zmp": "center" }, { "t": "${down}", "zmp": "right" }, { "t": 1.9, "zmp": "right" },
    { "t": 2.8, "zmp": "center" }
  ]
})";
  save(text);
  const Server server(file, {"--set", "down=1.1", "--set", "side=0.05"});
  ASSERT_TRUE(server.state()["error"].is_null()) << server.state()["error"];
  ASSERT_EQ(server.state()["keyframes"][1]["time"], 1.1);
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string changed = text;
    return changed.replace(changed.find(what), what.size(), by);
  };
  ASSERT_EQ(server.edit({{{"kind", "set"}, {"pointer", "/keyframes/1/t"}, {"value", 1.13}}}).first,
            200);
  EXPECT_EQ(contents(file), with("\"${down}\"", "\"${down} + 0.03\""));
  EXPECT_NEAR(server.state()["keyframes"][1]["time"].get<double>(), 1.13, 1e-9);
  ASSERT_EQ(server.post("undo", {{"hash", server.state()["hash"]}}).first, 200);
  const auto [status, answer] =
      server.post("pose", {{"time", 2.2}, {"drag", "left_foot"}, {"to", {0.0, 0.053, 0.0}}});
  ASSERT_EQ(status, 200) << answer;
  ASSERT_EQ(server.edit(answer["edits"]).first, 200);
  EXPECT_EQ(contents(file), with("\"${side}\"", "\"${side} + 0.003\""));
}

// The page has a button for the repair, so its messages name the button and not the command.
TEST_F(AuthorServer, AdvisesTheButtonOfTheRepair) {
  const Server server(file);
  ASSERT_EQ(server
                .edit({{{"kind", "set"},
                        {"pointer", "/keyframes/0/joints"},
                        {"value", {{"l_elbow", -170}}}}})
                .first,
            200);
  const std::string findings = server.state()["findings"].dump();
  EXPECT_NE(findings.find(" deg in this window, or choose Repair"), std::string::npos) << findings;
  EXPECT_EQ(findings.find("ayumi repair"), std::string::npos) << findings;
}

// A text that cannot be read as a pattern is not written; a pattern whose motion the robot cannot
// do is written, and the error is shown. While the motion is older than the text, only places that
// both have can be changed.
TEST_F(AuthorServer, RefusesEditsThatMakeThePatternUnreadable) {
  const Server server(file);
  const auto can_edit = [](const Json& state) {
    return state["features"].dump().find("\"edit\"") != std::string::npos;
  };
  for (const Json& edit : {set("/keyframes/1/t", 2.9), set("/phases/0/support", "left foot"),
                           set("/keyframes/1/wrong", 1)}) {
    const auto [status, answer] = server.edit(edit);
    EXPECT_EQ(status, 422) << edit;
    const std::string message = answer["message"];
    EXPECT_NE(message.find("nothing was written"), std::string::npos) << message;
    EXPECT_EQ(message.find(file.string()), std::string::npos) << "the page shows one file only";
    EXPECT_EQ(contents(file), walk);
  }
  ASSERT_EQ(server.edit(set("/phases/1/swing/to/0", 0.4)).first, 200);
  Json state = server.state();
  EXPECT_FALSE(state["error"].is_null());
  EXPECT_TRUE(can_edit(state)) << "the value can be typed anew";
  EXPECT_EQ(state["phases"][1]["swing"]["to"][0], 0.4) << "the timeline shows the text";
  ASSERT_EQ(server.edit(set("/phases/1/swing/to/0", 0.03)).first, 200);
  EXPECT_EQ(contents(file), walk);
  const std::string other = replaced("\"keyframes\": [", "\"keyframes\": [ { \"t\": 0 },");
  save(other);
  state = server.state_when([&](const Json& now) { return now["text"] == other; });
  EXPECT_FALSE(state["error"].is_null());
  EXPECT_FALSE(can_edit(state)) << "every keyframe has another place";
  const std::string broken = "{ \"format\": oops }";
  save(broken);
  state = server.state_when([&](const Json& now) { return now["text"] == broken; });
  EXPECT_EQ(state["error"]["line"], 1);
  EXPECT_EQ(state["error"]["message"].get<std::string>().find(file.string()), std::string::npos)
      << state["error"];
  save(walk);
  EXPECT_TRUE(can_edit(server.state_when([](const Json& now) { return now["error"].is_null(); })));
}

TEST_F(AuthorServer, NeverOverwritesAChangeOnDisk) {
  const Server server(file);
  const Json seen = server.state()["hash"];
  const std::string theirs = replaced("hoap1_walk", "theirs");
  save(theirs);
  const Json edits = {{{"kind", "set"}, {"pointer", "/keyframes/0/zmp"}, {"value", "left"}}};
  const auto [status, answer] = server.post("edit", {{"hash", seen}, {"edits", edits}});
  EXPECT_EQ(status, 409);
  EXPECT_EQ(contents(file), theirs);
  EXPECT_EQ(answer["theirs"], theirs);
  EXPECT_EQ(answer["mine"], replaced(R"("t": 0, "zmp": "center")", R"("t": 0, "zmp": "left")"));
  EXPECT_EQ(server.post("edit", {{"hash", answer["theirs_hash"]}, {"text", answer["mine"]}}).first,
            200);
  EXPECT_EQ(contents(file), answer["mine"].get<std::string>());
}

TEST_F(AuthorServer, KeepsLinksAndPermissions) {
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  fs::create_symlink(file, folder / "link.json");
  const Server server(folder / "link.json");
  ASSERT_EQ(server.edit({{{"kind", "set"}, {"pointer", "/name"}, {"value", "other"}}}).first, 200);
  EXPECT_TRUE(fs::is_symlink(folder / "link.json"));
  EXPECT_EQ(contents(file), replaced("hoap1_walk", "other"));
  EXPECT_EQ(fs::status(file).permissions(),
            fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2)
      << "nothing else is left behind";
}

// The point at which the page would draw a handle, taken from the row of the table.
std::array<double, 3> cog_of(const Json& state, const Json& row) {
  std::array<double, 3> cog{};
  const auto& columns = state["replay"]["columns"];
  for (size_t i = 0; i < columns.size(); ++i)
    for (size_t axis = 0; axis < 3; ++axis)
      if (columns[i] == std::string("cog.") + "xyz"[axis]) cog[axis] = row[i];
  return cog;
}

Json row_at(const Server& server, const Json& state, double time) {
  const std::string bytes = server.get("series?which=plan");
  const size_t width = state["replay"]["columns"].size();
  std::vector<float> table(bytes.size() / sizeof(float));
  std::memcpy(table.data(), bytes.data(), bytes.size());
  const auto at = static_cast<size_t>(std::lround(time * state["replay"]["rate"].get<double>()));
  Json row = Json::array();
  for (size_t i = 0; i < width; ++i) row.push_back(table[at * width + i]);
  return row;
}

// While something is dragged, the page shows the pattern as it will be after it is written. The
// text has durations, relative steps and blocks that repeat: edits change the words that the author
// wrote.
TEST_F(AuthorServer, EditsAPatternInFewWords) {
  const std::string text = R"({
  "format": "ayumi.pattern/1", "robot": "hoap1", "units": { "angle": "deg" },
  "phases": [
    { "duration": 1, "support": "both" },
    { "repeat": 2, "phases": [
      { "duration": 0.44, "support": "left", "swing": { "foot": "right", "step": { "forward": 0.03 } } },
      { "duration": 0.11, "support": "both" },
      { "duration": 0.44, "support": "right", "swing": { "foot": "left", "step": {} } },
      { "duration": 0.11, "support": "both" }
    ] },
    { "duration": 1, "support": "both" }
  ],
  "keyframes": [
    { "t": 0, "zmp": "center" },
    { "after": 0.6, "zmp": "center" },
    { "repeat": 2, "count": "i", "keyframes": [
      { "t": "1 + 1.1*${i}", "zmp": "left" }, { "after": 0.44, "zmp": "left" },
      { "after": 0.11, "zmp": "right" }, { "after": 0.44, "zmp": "right" }
    ] },
    { "after": 0.3, "zmp": "center" }
  ]
})";
  save(text);
  const Server server(file);
  const Json state = server.state();
  ASSERT_TRUE(state["error"].is_null()) << state["error"];
  ASSERT_EQ(state["phases"].size(), 10u);
  EXPECT_EQ(state["phases"][5]["pointer"], "/phases/1/phases/0");
  EXPECT_EQ(state["phases"][5]["repeated"], true);
  EXPECT_EQ(state["phases"][9]["until_pointer"], "/phases/2/duration");
  EXPECT_NEAR(state["phases"][9]["until_base"].get<double>(), 3.2, 1e-9);
  const auto dragged = [&](const Json& wish) {
    const auto [status, answer] = server.post("pose", wish);
    EXPECT_EQ(status, 200) << wish << answer;
    EXPECT_EQ(server.edit(answer["edits"]).first, 200);
    const Json now = server.state();
    EXPECT_TRUE(now["error"].is_null()) << now["error"];
    const std::string after = contents(file);
    EXPECT_EQ(server.post("undo", {{"hash", now["hash"]}}).first, 200);
    EXPECT_EQ(contents(file), text);
    return after;
  };
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string changed = text;
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return changed.replace(at, what.size(), by);
  };
  // The foot that has landed is moved 5 mm ahead: the step is 5 mm longer, and nothing else
  // changes.
  const auto& feet = state["handles"];
  ASSERT_EQ(feet[1]["name"], "right_foot");
  const std::string longer =
      dragged({{"time", 1.5}, {"drag", "right_foot"}, {"to", {0.035, -0.039, 0.0}}});
  EXPECT_EQ(longer, with("\"forward\": 0.03 ", "\"forward\": 0.035 "));
  // A key is moved between two keys with relative times: the later one stays where it is.
  const std::string keyed = dragged({{"time", 0.2}, {"joints", {{"l_elbow", -0.5}}}});
  EXPECT_NE(keyed.find("\"t\": 0.2"), std::string::npos) << keyed;
  EXPECT_NE(keyed.find("{ \"after\": 0.4, \"zmp\": \"center\", "), std::string::npos) << keyed;
  // Within a block, there is no room for a key of one round only.
  const auto [status, answer] =
      server.post("pose", {{"time", 1.3}, {"joints", {{"l_elbow", -0.5}}}});
  EXPECT_EQ(status, 422) << answer;
  EXPECT_NE(answer.dump().find("a repeated block"), std::string::npos) << answer;
}

TEST_F(AuthorServer, SaysThatTheFileIsGone) {
  const Server server(file);
  fs::remove(file);
  const Json gone = server.state_when([](const Json& now) { return !now["error"].is_null(); });
  EXPECT_NE(gone["error"].dump().find("no longer exists"), std::string::npos) << gone["error"];
  save(walk);
  EXPECT_TRUE(
      server.state_when([](const Json& now) { return now["error"].is_null(); })["consistent"]
          .get<bool>());
}

// The arm only moves between the keyframes around the new key.
TEST_F(AuthorServer, TheFirstKeyOfAJointKeepsTheMotionAround) {
  const Server server(file);
  const Json before = server.state();
  const auto [status, answer] =
      server.post("pose", {{"time", 2.4}, {"joints", {{"l_shoulder_pitch", 0.7}}}});
  ASSERT_EQ(status, 200) << answer;
  const std::string joint = "q.l_shoulder_pitch";
  const auto angle = [&](const Json& state, double t) {
    const auto& columns = state["replay"]["columns"];
    const auto i = std::find(columns.begin(), columns.end(), joint) - columns.begin();
    return row_at(server, state, t)[static_cast<size_t>(i)];
  };
  const double rest = angle(before, 2.4);
  ASSERT_EQ(server.edit(answer["edits"]).first, 200);
  const Json after = server.state();
  ASSERT_TRUE(after["error"].is_null()) << after["error"];
  EXPECT_NEAR(angle(after, 2.4), 0.7, 1e-3);
  for (const auto& frame : before["keyframes"])
    EXPECT_NEAR(angle(after, frame["time"]), rest, 1e-3) << frame["time"];
}

// A keyframe comes 20 ms after the drag. If it held the height, the COG would have to fall faster
// than gravity.
TEST_F(AuthorServer, TheFirstKeyOfTheHeightLeavesTimeForTheChange) {
  const Server server(file);
  const Json before = server.state();
  const auto height = [&](const Json& state, double t) {
    return cog_of(state, row_at(server, state, t))[2];
  };
  const double t = 2.2, rest = height(before, t);
  const auto cog = cog_of(before, row_at(server, before, t));
  const auto [status, answer] =
      server.post("pose", {{"time", t}, {"drag", "cog"}, {"to", {cog[0], cog[1], rest - 0.01}}});
  ASSERT_EQ(status, 200) << answer;
  ASSERT_EQ(server.edit(answer["edits"]).first, 200);
  const Json after = server.state();
  ASSERT_TRUE(after["error"].is_null()) << after["error"];
  EXPECT_NEAR(height(after, t), rest - 0.01, 2e-4);
  for (const double held : {1.67, 2.671}) EXPECT_NEAR(height(after, held), rest, 2e-4) << held;
}

TEST_F(AuthorServer, WhatIsDraggedIsWhatThePatternThenIs) {
  const Server server(file);
  const Json state = server.state();
  const auto cog = cog_of(state, row_at(server, state, 2.4));
  const std::vector<Json> wishes = {
      {{"time", 2.4}, {"joints", {{"l_shoulder_pitch", 0.7}}}},
      {{"time", 2.4}, {"drag", "left_hand"}, {"to", {0.2, 0.15, 0.25}}},
      {{"time", 2.4}, {"drag", "left_foot"}, {"to", {0.05, 0.045, 0.0}}},
      {{"time", 2.4}, {"drag", "right_foot"}, {"to", {0.052, -0.0395, 0.016}}},
      {{"time", 0.4}, {"drag", "right_foot"}, {"to", {0.005, -0.042, 0.0}}},
      {{"time", 2.4}, {"drag", "trunk"}, {"to", {0.06, 0.03, 0.46}}},
      {{"time", 2.4}, {"drag", "cog"}, {"to", {cog[0] + 0.002, cog[1] + 0.001, cog[2] - 0.003}}}};
  for (const Json& wish : wishes) {
    const auto [status, answer] = server.post("pose", wish);
    ASSERT_EQ(status, 200) << wish << answer;
    ASSERT_TRUE(answer["row"].is_array()) << wish << answer["message"];
    ASSERT_FALSE(answer["edits"].empty()) << wish;
    EXPECT_EQ(contents(file), walk) << "nothing is written while it is tried";
    ASSERT_EQ(server.edit(answer["edits"]).first, 200);
    const Json now = server.state();
    ASSERT_TRUE(now["error"].is_null()) << now["error"];
    const Json row = row_at(server, now, wish["time"]);
    const auto& columns = now["replay"]["columns"];
    for (size_t i = 0; i < columns.size(); ++i) {
      const std::string name = columns[i];
      if (!name.starts_with("q.") && !name.starts_with("cog.") && !name.starts_with("base."))
        continue;
      // 0.1 degrees and 0.2 mm: the preview is sampled more coarsely.
      EXPECT_NEAR(row[i].get<double>(), answer["row"][i].get<double>(),
                  name[0] == 'q' ? 2e-3 : 2e-4)
          << wish << name;
    }
    ASSERT_EQ(server.post("undo", {{"hash", now["hash"]}}).first, 200);
    EXPECT_EQ(contents(file), walk);
  }
}

TEST_F(AuthorServer, ADragOfTheTrunkLeansItOrMovesItUpAndDown) {
  const Server server(file);
  const auto edits_of = [&](const std::vector<double>& to) {
    const Json wish = {{"time", 2.4}, {"drag", "trunk"}, {"from", {0, 0, 0}}, {"to", to}};
    const auto [status, answer] = server.post("pose", wish);
    EXPECT_EQ(status, 200) << answer;
    EXPECT_TRUE(answer["message"].is_null()) << answer["message"];
    return answer["edits"].dump();
  };
  const std::string lean = edits_of({0.01, 0.005, 0}), rise = edits_of({0, 0, -0.004});
  EXPECT_NE(lean.find("torso"), std::string::npos) << lean;
  EXPECT_EQ(lean.find("height"), std::string::npos) << lean;
  EXPECT_EQ(lean.find("yaw"), std::string::npos) << lean;
  EXPECT_NE(rise.find("height"), std::string::npos) << rise;
  EXPECT_EQ(rise.find("torso"), std::string::npos) << rise;
}

// If an arm turned back at its limits, the targets of its servos would exceed the limits, because
// they lead the motion. So a dragged arm keeps a distance from its limits.
TEST_F(AuthorServer, AnArmThatIsDraggedTooFarStaysWithinItsLimits) {
  const Server server(file);
  for (const double t : {2.0, 2.5, 3.0}) {
    const double up = t == 2.5 ? -0.6 : 0.9;
    const auto answer = server.post(
        "pose", {{"time", t}, {"drag", "left_hand"}, {"to", {0.1, 0.4 + 0.3 * (t - 2), up}}});
    ASSERT_FALSE(answer.second["message"].is_null());
    ASSERT_EQ(server.edit(answer.second["edits"]).first, 200);
  }
  for (const Json& finding : server.state()["findings"])
    EXPECT_NE(finding["kind"], "table_position") << finding;
}

TEST_F(AuthorServer, SaysWhatCannotBeReached) {
  const Server server(file);
  const auto far = server.post("pose", {{"time", 2.4}, {"drag", "left_hand"}, {"to", {3, 0, 0}}});
  ASSERT_EQ(far.first, 200);
  EXPECT_NE(far.second["message"].get<std::string>().find(" mm away from the wanted place"),
            std::string::npos);
  const auto foot =
      server.post("pose", {{"time", 2.4}, {"drag", "left_foot"}, {"to", {0.5, 0, 0}}});
  EXPECT_TRUE(foot.second["edits"].empty());
  EXPECT_NE(foot.second["message"].get<std::string>().find("out of reach by"), std::string::npos);
  EXPECT_EQ(server.post("pose", {{"time", 2.4}, {"drag", "tail"}, {"to", {0, 0, 0}}}).first, 422);
}

// A key in a phase with goals instead of keys would make the pattern unreadable: nothing is
// written.
TEST_F(AuthorServer, RefusesAKeyInsideAViipPhase) {
  const std::string text = contents(AYUMI_SOURCE_DIR "/patterns/hoap1_viip_step.json");
  save(text);
  const Server server(file);
  const Json key = {{"t", 1.5}, {"cog", {{"height", 0.22}}}};
  const auto refused =
      server.edit(Json::array({{{"kind", "set"}, {"pointer", "/keyframes"}, {"value", {key}}}}));
  EXPECT_EQ(refused.first, 422) << refused.second;
  EXPECT_NE(refused.second["message"].get<std::string>().find(
                "the key at 1.5 s lies inside the VIIP phase from 0.5 to 5.5 s"),
            std::string::npos)
      << refused.second;
  EXPECT_EQ(contents(file), text) << "nothing is written";
  EXPECT_TRUE(server.state()["error"].is_null());
}

// Targets of hands are moved where they are written, and a keyframe becomes its mirror image.
TEST_F(AuthorServer, MovesTargetsAndMirrorsKeyframes) {
  const std::string text = R"({
  "format": "ayumi.pattern/1", "robot": "humanoid30", "units": { "angle": "deg" },
  "parameters": { "up": 0.6 },
  "phases": [ { "until": 3, "support": "both" } ],
  "keyframes": [
    { "t": 0, "posture": "home" },
    // beside the body
    { "t": 1, "hands": { "left": [0.2, 0.25, "${up}"] }, "joints": { "r_elbow": -50 } },
    { "t": 2, "hands": { "left": { "position": [0.25, 0.2, 0.1], "frame": "trunk" } }, "gaze": [1, 0.2, 1] }
  ]
}
)";
  save(text);
  const Server server(file);
  const Json state = server.state();
  ASSERT_TRUE(state["error"].is_null()) << state["error"];
  ASSERT_EQ(state["targets"].size(), 3u);
  EXPECT_EQ(state["targets"][0]["place"], Json({0.2, 0.25, 0.6}));
  EXPECT_EQ(state["targets"][0]["until"], 2);
  EXPECT_EQ(state["targets"][0]["handle"], "left_hand");
  EXPECT_GT(double(state["targets"][1]["place"][2]), 0.5)
      << "in the world, not in the trunk's frame";
  const auto moved = server.post(
      "pose", {{"time", 1}, {"target", "/keyframes/1/hands/left"}, {"to", {0.22, 0.25, 0.6}}});
  ASSERT_EQ(moved.first, 200) << moved.second;
  EXPECT_TRUE(moved.second["message"].is_null()) << moved.second["message"];
  EXPECT_EQ(moved.second["edits"],
            json_of(R"([{"kind": "set", "pointer": "/keyframes/1/hands/left/0", "value": 0.22}])"));
  const auto far = server.post(
      "pose", {{"time", 1}, {"target", "/keyframes/1/hands/left"}, {"to", {1.5, 0.25, 0.6}}});
  EXPECT_TRUE(far.second["edits"].empty());
  EXPECT_NE(far.second["message"].get<std::string>().find("out of reach by"), std::string::npos)
      << far.second;
  const auto mirrored = server.post("mirror", {{"pointer", "/keyframes/1"}});
  ASSERT_EQ(mirrored.first, 200) << mirrored.second;
  ASSERT_EQ(server.edit(mirrored.second["edits"]).first, 200);
  const std::string now = contents(file);
  EXPECT_NE(now.find("// beside the body"), std::string::npos);
  const Json key = json_of(now, true)["keyframes"][1];
  EXPECT_FALSE(key["hands"].contains("left")) << key;
  EXPECT_EQ(key["hands"]["right"], Json({0.2, -0.25, 0.6})) << key;
  EXPECT_EQ(key["joints"], Json({{"l_elbow", -50}})) << key;
}

// Expressions, comments and the spacing inside a keyframe stay when it is mirrored.
TEST_F(AuthorServer, MirrorsAKeyframeInTheWordsOfItsAuthor) {
  const std::string before =
      R"({ "t": 0.71, "zmp": "left", /* up */ "joints": {"l_elbow" :"-6*pi"} })";
  save(replaced(R"({ "t": 0.71, "zmp": "center" })", before));
  const Server server(file);
  const auto [status, answer] = server.post("mirror", {{"pointer", "/keyframes/1"}});
  ASSERT_EQ(status, 200) << answer;
  EXPECT_EQ(answer["text"],
            replaced(R"({ "t": 0.71, "zmp": "center" })",
                     R"({ "t": 0.71, "zmp": "right", /* up */ "joints": {"r_elbow" :"-6*pi"} })"));
  // If the file has changed since, the text is not written over the change.
  ASSERT_EQ(server.edit(set("/phases/1/swing/lift", 0.017)).first, 200);
  EXPECT_EQ(server.post("edit", {{"hash", answer["hash"]}, {"text", answer["text"]}}).first, 409);
}

TEST_F(AuthorServer, CapturesPosturesAndTheirMirrorImages) {
  const Server server(file);
  const auto [status, plain] = server.post("posture", {{"time", 2.4}, {"name", "a b"}});
  ASSERT_EQ(status, 200);
  const auto mirrored =
      server.post("posture", {{"time", 2.4}, {"name", "other"}, {"mirror", true}}).second;
  const Json& angles = plain["edits"][0]["value"];
  const Json& image = mirrored["edits"][0]["value"];
  EXPECT_EQ(angles["l_knee"], image["r_knee"]);
  EXPECT_EQ(angles["r_hip_pitch"], image["l_hip_pitch"]);
  ASSERT_EQ(server.edit(plain["edits"]).first, 200);
  const Json state = server.state();
  EXPECT_EQ(state["own_postures"], Json({"a b"}));
  EXPECT_TRUE(state["consistent"].get<bool>());
}

Json result_of(const Server& server, const std::string& kind,
               const Json& options = Json::object()) {
  const auto [status, answer] = server.post("job", {{"kind", kind}, {"options", options}});
  EXPECT_EQ(status, 200) << answer;
  return server.state_when(
      [&](const Json& now) { return now["result"].is_object() && now["result"]["kind"] == kind; });
}

// With control, the knees of this hop need more torque at the landing than in open loop.
TEST_F(AuthorServer, ASimulationSaysWhatIsWorseWithControl) {
  save(R"({
  "format": "ayumi.pattern/1", "robot": "hoap1", "profile": "hoap1-strong",
  "units": { "angle": "deg" },
  "phases": [
    { "until": 1.5, "support": "both" },
    { "until": 1.65, "support": "none" },
    { "until": 3.2, "support": "both" }
  ],
  "keyframes": [
    { "t": 0.5, "cog": { "height": 0.245 } },
    { "t": 1.32, "cog": { "height": 0.19 } },
    { "t": 1.5, "cog": { "height": 0.225 } },
    { "t": 1.65, "cog": { "height": 0.225 } },
    { "t": 1.83, "cog": { "height": 0.19 } },
    { "t": 2.7, "cog": { "height": 0.245 } }
  ],
  "controller": { "type": "dtad" }
}
)");
  const Server server(file);
  const Json lines = result_of(server, "simulate", {{"law", "both"}})["result"]["lines"];
  ASSERT_EQ(lines.size(), 3u) << lines;
  EXPECT_TRUE(lines[2].get<std::string>().starts_with(
      "some figures are worse with control than in open loop: the largest torque is "))
      << lines;
}

TEST_F(AuthorServer, JobsAnswerOnTheSameTimeline) {
  const Server server(file);
  EXPECT_TRUE(result_of(server, "check")["result"]["good"].get<bool>());
  const Json run = result_of(server, "simulate", {{"law", "both"}});
  EXPECT_TRUE(run["result"]["good"].get<bool>()) << run["result"];
  EXPECT_EQ(run["result"]["lines"].size(), 2u);
  EXPECT_EQ(run["motions"], Json({"plan", "closed_loop", "open_loop"}));
  EXPECT_FALSE(run["result"]["marks"].empty()) << "the push";
  const Json table = result_of(server, "export");
  ASSERT_EQ(table["result"]["files"], Json({"walk_hoap.csv"})) << table["result"];
  EXPECT_TRUE(fs::exists(folder / "walk_hoap.csv"));
  EXPECT_EQ(result_of(server, "check")["result"]["kind"], "check");
  EXPECT_EQ(result_of(server, "export")["result"]["files"], Json({"walk_hoap_2.csv"}));
  // A faulty pattern is repaired, and the text of the repair is accepted.
  save(replaced(R"({ "t": 3.771, "zmp": "left" })",
                R"({ "t": 3.771, "zmp": "left", "joints": { "l_elbow": -170 } })"));
  server.state_when([](const Json& now) { return now["consistent"] == false; });
  EXPECT_FALSE(result_of(server, "export")["result"]["good"].get<bool>());
  EXPECT_FALSE(fs::exists(folder / "walk_hoap_3.csv"));
  const Json repaired = result_of(server, "repair");
  ASSERT_TRUE(repaired["result"]["good"].get<bool>()) << repaired["result"];
  EXPECT_NE(server.get("series?which=repair"), "");
  ASSERT_EQ(
      server.post("edit", {{"hash", repaired["hash"]}, {"text", repaired["result"]["text"]}}).first,
      200);
  EXPECT_TRUE(server.state()["consistent"].get<bool>());
  EXPECT_NE(contents(file).find("// HOAP-1 walks eight steps"), std::string::npos);
}

TEST_F(AuthorServer, AJobIsCancelledAndCtrlCEndsTheServerWithinASecond) {
  Server server(file);
  const auto [status, answer] = server.post("job", {{"kind", "push"}});
  ASSERT_EQ(status, 200);
  EXPECT_EQ(server.post("job", {{"kind", "check"}}).first, 422) << "one job at a time";
  const std::string id = answer["id"];
  EXPECT_EQ(server.client().Delete(server.root() + "job/99")->status, 404);
  EXPECT_EQ(server.client().Delete(server.root() + "job/" + id)->status, 200);
  int again = 422;
  for (int i = 0; i < 500 && again == 422; ++i) {
    again = server.post("job", {{"kind", "push"}}).first;
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(again, 200) << "the job has ended";
  // One client is a page that listens, and the other sends nothing.
  std::thread listener([&] {
    httplib::Client client = server.client();
    client.Get(server.root() + "events", [](const char*, size_t) { return true; });
  });
  const Connection idle(server.port());
  std::this_thread::sleep_for(200ms);
  const auto [seconds, exit_code] = server.interrupt();
  listener.join();
  EXPECT_LT(seconds, 1.0);
  EXPECT_EQ(exit_code, 0);
}

TEST_F(AuthorServer, CtrlCEndsEachJobWithinASecond) {
  save(replaced(R"({ "t": 3.771, "zmp": "left" })",
                R"({ "t": 3.771, "zmp": "left", "joints": { "l_elbow": -170 } })"));
  for (const char* const kind : {"repair", "simulate", "push"}) {
    Server server(file);
    ASSERT_EQ(server.post("job", {{"kind", kind}, {"options", {{"law", "both"}}}}).first, 200);
    std::this_thread::sleep_for(300ms);
    const auto [seconds, exit_code] = server.interrupt();
    EXPECT_LT(seconds, 1.0) << kind;
    EXPECT_EQ(exit_code, 0) << kind;
  }
}

// On a busy machine, a program may have to wait for longer than the patience of its caller.
TEST_F(AuthorServer, AServerThatEndsLateHasEndedAsItShould) {
  Server server(file);
  ASSERT_EQ(server.post("job", {{"kind", "push"}}).first, 200);
  const auto [seconds, exit_code] = server.interrupt(900ms);
  EXPECT_GT(seconds, 0.9);
  EXPECT_EQ(exit_code, 0);
}

TEST_F(AuthorServer, ServesTheOtherRobotToo) {
  const std::string other = contents(AYUMI_SOURCE_DIR "/patterns/humanoid30_walk.json");
  write(folder / "h.json", other);
  const Server server(folder / "h.json");
  const Json state = server.state();
  ASSERT_TRUE(state["error"].is_null()) << state["error"];
  EXPECT_EQ(state["robot"], "humanoid30");
  EXPECT_EQ(state["replay"]["bodies"].size(), state["replay"]["joints"].size() + 1);
  for (const Json& handle : state["handles"]) {
    const Json wish = {{"time", 1.0}, {"drag", handle["name"]}, {"to", {0.1, 0.05, 0.6}}};
    const auto [status, answer] = server.post("pose", wish);
    EXPECT_EQ(status, 200) << handle << answer;
    EXPECT_TRUE(answer["row"].is_array() || answer["message"].is_string());
  }
}

TEST_F(AuthorServer, RefusesWhatItCannotShow) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& reason,
                           int exit_code) {
    std::vector<std::string> all = {"author"};
    all.insert(all.end(), words.begin(), words.end());
    const Output said = run_program(all, folder.path());
    EXPECT_EQ(said.exit_code, exit_code) << said.err;
    EXPECT_NE(said.err.find(reason), std::string::npos) << said.err;
  };
  refused({"nothing.json"}, "no such file", 3);
  refused({"-"}, "standard input", 2);
  refused({folder.path().string()}, "folder", 3);
  const Server server(file);
  refused({"walk.json", "--port", std::to_string(server.port())}, "is taken", 3);
}

}  // namespace
}  // namespace ayumi::test
