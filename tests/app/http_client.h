#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <string>

namespace lobe::test {

/// A TCP connection, by bare sockets, so that requests can be as wrong as they like.
class Connection {
 public:
  explicit Connection(int port, const char* address = "127.0.0.1")
      : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(uint16_t(port));
    inet_pton(AF_INET, address, &to.sin_addr);
    open_ = connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool open() const { return open_; }
  void Send(const std::string& text) { (void)!send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  /// Everything until the other side closes.
  std::string Receive() {
    std::string all;
    char buffer[65536];
    for (ssize_t n; (n = recv(socket_, buffer, sizeof buffer, 0)) > 0;) all.append(buffer, size_t(n));
    return all;
  }

 private:
  int socket_;
  bool open_;
};

struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;
  std::string body;
};

/// `path` is sent as it is. An empty `host` leaves the header out.
inline HttpAnswer Ask(int port, const std::string& path, const std::string& host = "localhost",
                      const std::string& method = "GET", const std::string& more_headers = "") {
  Connection connection(port);
  connection.Send(method + " " + path + " HTTP/1.1\r\n" + (host.empty() ? "" : "Host: " + host + "\r\n") +
                  more_headers + "\r\n");
  const std::string all = connection.Receive();
  HttpAnswer answer;
  const size_t end = all.find("\r\n\r\n");
  if (end == std::string::npos) return answer;
  answer.status = std::atoi(all.substr(all.find(' ') + 1, 3).c_str());
  answer.body = all.substr(end + 4);
  for (size_t line = all.find("\r\n") + 2; line < end;) {
    const size_t next = all.find("\r\n", line), colon = all.find(": ", line);
    answer.headers[all.substr(line, colon - line)] = all.substr(colon + 2, next - colon - 2);
    line = next + 2;
  }
  return answer;
}

}  // namespace lobe::test
