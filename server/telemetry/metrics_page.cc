#include "server/telemetry/metrics_page.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <charconv>
#include <optional>
#include <thread>
#include <utility>

namespace poise::server {
namespace {

constexpr int kThreads = 2;  // one who reads slowly does not hold up the next
constexpr char kContentType[] = "text/plain; version=0.0.4; charset=utf-8";

// "127.0.0.1:9464", "[::1]:9464"
struct Endpoint {
  std::string host;
  int port = 0;
};

std::optional<Endpoint> ParseEndpoint(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  Endpoint endpoint{.host = address.substr(0, colon)};
  if (endpoint.host.starts_with('[') && endpoint.host.ends_with(']')) {
    endpoint.host = endpoint.host.substr(1, endpoint.host.size() - 2);
  }
  const char* const end = address.data() + address.size();
  const auto parsed = std::from_chars(address.data() + colon + 1, end, endpoint.port);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return endpoint;
}

// Unlike the library's default: two processes on one port would both seem to work.
void RefuseSharedPort(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

}  // namespace

class MetricsPage::Listener {
 public:
  explicit Listener(std::function<std::string()> text) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_socket_options(RefuseSharedPort);
    server_.Get("/metrics",
                [text = std::move(text)](const httplib::Request&, httplib::Response& response) {
                  response.set_content(text(), kContentType);
                });
  }
  ~Listener() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }

  bool Start(const Endpoint& endpoint) {
    if (!server_.bind_to_port(endpoint.host, endpoint.port)) return false;
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // stop() does nothing before the loop runs.
    while (!server_.is_running()) std::this_thread::yield();
    return true;
  }

 private:
  httplib::Server server_;
  std::thread thread_;
};

StatusOr<std::unique_ptr<MetricsPage>> MetricsPage::Open(const std::string& address,
                                                         std::function<std::string()> text) {
  auto listener = std::make_unique<Listener>(std::move(text));
  const std::optional<Endpoint> endpoint = ParseEndpoint(address);
  if (!endpoint || !listener->Start(*endpoint)) {
    return base::FailedPrecondition(
        "CANNOT_LISTEN", "metrics",
        fmt::format("cannot serve metrics on {}: expected ADDR:PORT of this machine that no other "
                    "program has",
                    address));
  }
  return std::unique_ptr<MetricsPage>(new MetricsPage(std::move(listener)));
}

MetricsPage::MetricsPage(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
MetricsPage::~MetricsPage() = default;

}  // namespace poise::server
