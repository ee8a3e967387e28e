#pragma once

#include <memory>

#include "app/site.h"

namespace lobe {

/// Serves files from memory to this machine alone (127.0.0.1), by threads of its own. The one place that
/// knows cpp-httplib.
///
/// Answers GET and HEAD of exact names, "/" being index.html; there is no way from a name to the file system.
/// Only to requests that call it 127.0.0.1, localhost or [::1], at any port: pages from elsewhere must not
/// read solutions by giving their own name this address (DNS rebinding), and tunnels may change the port.
/// Nothing is to be cached, as the next solution may come from the same address.
class HttpServer {
 public:
  /// Takes a port, 0: any free one. Requests wait until Start. Throws InputError if it cannot be had.
  explicit HttpServer(int port);
  /// Stops at once: whoever is still being served is cut off.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  void Start(SiteFiles files);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobe
