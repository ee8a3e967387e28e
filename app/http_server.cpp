#include "app/http_server.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

#include <httplib.h>

#include "app/mime_type.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr const char* kAddress = "127.0.0.1";

/// How many connections are open. Threads that outlive the server still count down.
using OpenConnections = std::atomic<int>;

/// True if none is left within `patience`.
bool WaitForNone(const OpenConnections& open, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (open.load() > 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A thread for every connection. The library's own pool has few threads, which a browser's idle connections
/// would use up, and joins them all in the end, up to the longest time-out.
class ThreadPerConnection : public httplib::TaskQueue {
 public:
  explicit ThreadPerConnection(std::shared_ptr<OpenConnections> open) : open_(std::move(open)) {}

  void enqueue(std::function<void()> serve) override {
    open_->fetch_add(1);
    const auto run = [open = open_, serve = std::move(serve)] {
      serve();
      open->fetch_sub(1);
    };
    try {
      std::thread(run).detach();
    } catch (const std::system_error&) {  // no more threads: one after the other then
      run();
    }
  }
  void shutdown() override {}

 private:
  std::shared_ptr<OpenConnections> open_;
};

/// Is this Host header one of this machine's own names, whatever the port?
bool NamesLoopback(const std::string& host) {
  const size_t end = host.starts_with('[') ? host.find(']') + 1 : std::min(host.find(':'), host.size());
  const std::string rest = host.substr(end);
  const bool port = rest.starts_with(':') && rest.find_first_not_of("0123456789", 1) == std::string::npos;
  if (!rest.empty() && !port) return false;
  std::string name = host.substr(0, end);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name == kAddress || name == "localhost" || name == "[::1]";
}

void Refuse(int status, const char* sentence, httplib::Response* response) {
  response->status = status;
  response->set_content(sentence, "text/plain; charset=utf-8");
}

void Send(const std::vector<uint8_t>& bytes, const std::string& type, httplib::Response* response) {
  if (bytes.empty()) {
    response->set_content("", type);
    return;
  }
  // In pieces, between which the library looks whether it is to stop; and never a copy of the whole.
  response->set_content_provider(
      bytes.size(), type, [&bytes](size_t offset, size_t length, httplib::DataSink& sink) {
        constexpr size_t kPiece = size_t{1} << 18;
        return sink.write(reinterpret_cast<const char*>(bytes.data()) + offset, std::min(length, kPiece));
      });
}

}  // namespace

struct HttpServer::Impl {
  httplib::Server server;
  SiteFiles files;
  int port = 0;
  std::shared_ptr<OpenConnections> open = std::make_shared<OpenConnections>(0);
  std::thread listener;

  void Answer(const httplib::Request& request, httplib::Response& response) const {
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    if (!NamesLoopback(request.get_header_value("Host"))) {
      return Refuse(403, "This server answers to 127.0.0.1 and localhost only.\n", &response);
    }
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      return Refuse(405, "Only GET and HEAD are answered.\n", &response);
    }
    // The library would hand out ranges beyond the end.
    if (!request.ranges.empty()) return Refuse(416, "Files are sent whole only.\n", &response);
    const auto found = files.find(request.path == "/" ? "index.html" : request.path.substr(1));
    if (!request.path.starts_with('/') || found == files.end()) {
      return Refuse(404, "There is no such file.\n", &response);
    }
    Send(found->second, MimeType(found->first), &response);
  }
};

HttpServer::HttpServer(int port) : impl_(std::make_unique<Impl>()) {
  httplib::Server& server = impl_->server;
  // The library's default is SO_REUSEPORT: two servers would share a port, and each get half the requests.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  errno = 0;
  impl_->port = port == 0                             ? server.bind_to_any_port(kAddress)
                : server.bind_to_port(kAddress, port) ? port
                                                      : -1;
  if (impl_->port < 0) {
    throw InputError("port " + std::to_string(port) + " of this machine cannot be had" +
                     (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
  }
}

HttpServer::~HttpServer() {
  if (!impl_->listener.joinable()) return;
  impl_->server.stop();
  impl_->listener.join();
  // A client that dawdles is not waited for. Its thread ends with the process, and may look at what it serves
  // until then: that is left behind.
  if (!WaitForNone(*impl_->open, std::chrono::milliseconds(200))) static_cast<void>(impl_.release());
}

int HttpServer::port() const { return impl_->port; }

void HttpServer::Start(SiteFiles files) {
  impl_->files = std::move(files);
  httplib::Server& server = impl_->server;
  server.new_task_queue = [open = impl_->open] { return new ThreadPerConnection(open); };
  // One request a connection: cheap from a machine to itself, and nothing is left idle.
  server.set_keep_alive_max_count(1);
  // A page may be busy with what it has; five seconds, the default, would cut it off.
  server.set_write_timeout(std::chrono::minutes(5));
  server.set_pre_routing_handler([impl = impl_.get()](const auto& request, auto& response) {
    impl->Answer(request, response);
    return httplib::Server::HandlerResponse::Handled;
  });
  impl_->listener = std::thread([&server] { server.listen_after_bind(); });
  // Before it listens it cannot be told to stop.
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace lobe
