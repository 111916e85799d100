#include "viewer/view_server.h"

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/lcmtypes/examples.h"
#include "tests/viewer/page_model.h"

namespace nextview {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

class ViewServerTest : public testing::Test {
 protected:
  ViewServerTest() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("nextview-view-server-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "index.html") << "the page";
    std::ofstream(folder_ / "view.js") << "the script";
    runs_.emplace_back("one");
    runs_[0].viewed.set_config(example<run_config_t>());
    server_ = std::make_unique<ViewServer>(runs_, folder_, 0);
    thread_ = std::thread([this] { server_->serve(); });
  }
  ~ViewServerTest() override {
    server_->stop();
    thread_.join();
    std::filesystem::remove_all(folder_);
  }

  tcp::socket connect() {
    tcp::socket socket(io_);
    socket.connect({asio::ip::address_v4::loopback(), server_->port()});
    return socket;
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }

  http::response<http::string_body> get(const std::string& target, const std::string& host,
                                        http::verb verb = http::verb::get) {
    tcp::socket socket = connect();
    http::request<http::string_body> request(verb, target, 11);
    request.set(http::field::host, host);
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    if (verb == http::verb::head) parser.skip(true);
    http::read(socket, buffer, parser);
    return parser.release();
  }

  using Socket = beast::websocket::stream<tcp::socket>;
  std::unique_ptr<Socket> open(const std::string& origin, beast::error_code& error) {
    auto socket = std::make_unique<Socket>(connect());
    socket->set_option(
        beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& request) {
          if (!origin.empty()) request.set(http::field::origin, origin);
        }));
    socket->handshake(host(), "/socket", error);
    return socket;
  }
  static Outbox::Message read(Socket& socket) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const auto* first = static_cast<const std::uint8_t*>(buffer.data().data());
    return {socket.got_binary(), {first, first + buffer.size()}};
  }
  /// Reads until the page holds a view in full.
  static void read_until(Socket& socket, PageModel& page, int view) {
    while (page.view != view) {
      page.take(read(socket));
      socket.write(asio::buffer(R"({"got": )" + std::to_string(page.messages) + "}"));
    }
  }

  std::filesystem::path folder_;
  std::deque<ServedRun> runs_;
  std::unique_ptr<ViewServer> server_;
  std::thread thread_;
  asio::io_context io_;
};

TEST_F(ViewServerTest, ServesThePageAndNothingElse) {
  const auto page = get("/", host());
  EXPECT_EQ(page.result_int(), 200U);
  EXPECT_EQ(page.body(), "the page");
  EXPECT_NE(page["Content-Security-Policy"].find("default-src 'self'"), beast::string_view::npos);
  EXPECT_EQ(get("/view.js?x", host()).body(), "the script");
  EXPECT_EQ(get("/view.js", host())[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/", host(), http::verb::head).result_int(), 200U);
  EXPECT_EQ(get("/", host(), http::verb::post).result_int(), 405U);
  for (const char* elsewhere : {"/nothing", "/../view.js", "/%2e%2e/etc/passwd", "//etc/passwd",
                                "/socket", "view.js", "*"}) {
    EXPECT_EQ(get(elsewhere, host()).result_int(), 404U) << elsewhere;
  }
}

TEST_F(ViewServerTest, IsForNoOtherHostAndNoOtherPage) {
  EXPECT_EQ(get("/", "evil.example").result_int(), 421U);
  EXPECT_EQ(get("/", "127.0.0.1:1").result_int(), 421U);
  for (const char* origin : {"", "http://evil.example", "null", "http://127.0.0.1:1"}) {
    beast::error_code error;
    open(origin, error);
    EXPECT_EQ(error, beast::websocket::error::upgrade_declined) << origin;
  }
}

TEST_F(ViewServerTest, IsOnThisMachineOnly) {
  // 127.0.0.2 is this machine too, and would be answered by who listens on every address.
  tcp::socket socket(io_);
  beast::error_code error;
  socket.connect({asio::ip::make_address_v4("127.0.0.2"), server_->port()}, error);
  EXPECT_EQ(error, asio::error::connection_refused);
}

TEST_F(ViewServerTest, TellsPagesOfEveryViewAndThoseThatComeBackOfAll) {
  PageModel page;
  for (int time = 1; time <= 2; ++time) {
    beast::error_code error;
    const auto socket = open("http://" + host(), error);
    ASSERT_FALSE(error) << error.message();
    socket->write(asio::buffer(std::string(R"({"show": 0, "view": null})")));
    PageModel again;
    read_until(*socket, again, time - 1);
    EXPECT_EQ(again.facts.at("config").at("scene"), "room");
    EXPECT_EQ(again.rows.size(), static_cast<std::size_t>(time - 1));
    ViewedRun::View view;
    view.row = {{"view", time}};
    view.blocks.push_back({1, {0, 0, 0}, std::vector<std::uint8_t>(8)});
    runs_[0].viewed.add_view(view);
    read_until(*socket, again, time);
    EXPECT_EQ(again.voxels().size(), 1U);
  }
}

TEST_F(ViewServerTest, LetsARunGoOnThatNobodyLooksAt) {
  runs_[0].viewed.set_pausable();
  beast::error_code error;
  auto socket = open("http://" + host(), error);
  ASSERT_FALSE(error);
  socket->write(asio::buffer(std::string(R"({"pace": 0, "last_view": 3})")));
  while (runs_[0].viewed.pace() != 3) std::this_thread::yield();
  socket.reset();
  while (runs_[0].viewed.pace() != kAnyView) std::this_thread::yield();
}

TEST_F(ViewServerTest, LeavesAPageThatTalksNonsense) {
  beast::error_code error;
  auto socket = open("http://" + host(), error);
  ASSERT_FALSE(error);
  socket->write(asio::buffer(std::string("nonsense")));
  beast::flat_buffer buffer;
  while (!error) socket->read(buffer, error);
  EXPECT_EQ(error, beast::websocket::error::closed);
  EXPECT_EQ(get("/", host()).result_int(), 200U) << "others are served on";
}

TEST_F(ViewServerTest, SaysWhenThePortIsTaken) {
  try {
    const ViewServer second(runs_, folder_, server_->port());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("port " + std::to_string(server_->port())),
              std::string::npos);
  }
}

}  // namespace
}  // namespace nextview
