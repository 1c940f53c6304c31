// Follows a host over UDP, decides every state and writes a trace: follower PRESET TRACE
// It prints its port, and ends when no packet has come for three seconds.
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <trimtab/host/decoder.h>
#include <trimtab/measure/trace_file.h>
#include <trimtab/preset/preset.h>
#include <trimtab/session/session.h>
#include <chrono>
#include <cstdio>

static double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

static int refused(const trimtab::Findings& findings) {
  return std::fprintf(stderr, "%s\n", toString(findings).c_str()), 1;
}

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: follower PRESET TRACE\n", stderr), 2;
  const auto preset = trimtab::loadPreset(argv[1]);
  if (!preset) return refused(preset.findings());
  const auto parameters = trimtab::validate(preset->parameters);
  if (!parameters) return refused(parameters.findings());
  auto trace = trimtab::TraceFile::open(argv[2]);
  if (!trace) return refused(trace.findings());

  const int udp = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in here{AF_INET, 0, {htonl(INADDR_LOOPBACK)}, {}};
  socklen_t size = sizeof here;
  const timeval silence{3, 0};
  setsockopt(udp, SOL_SOCKET, SO_RCVTIMEO, &silence, sizeof silence);
  if (bind(udp, reinterpret_cast<sockaddr*>(&here), size) != 0) return std::perror("bind"), 1;
  getsockname(udp, reinterpret_cast<sockaddr*>(&here), &size);
  std::printf("%d\n", ntohs(here.sin_port));
  std::fflush(stdout);

  trimtab::HostDecoder decoder{trimtab::HostChoice((*parameters)->host)};
  trimtab::Session session(*parameters);
  session.keepRows(true);
  std::byte bytes[65536];
  for (ssize_t length; (length = recv(udp, bytes, sizeof bytes, 0)) >= 0;) {
    const double arrival = now();
    if (const auto state = decoder.accept({{bytes, std::size_t(length)}, arrival, "host"})) {
      const trimtab::ReceivedState received{*state, arrival, now()};
      session.receive({&received, 1});                                                        // decides
      if (const auto image = session.request(now(), 1280, 720)) session.finished({}, now());  // draw here
    }
  }
  std::vector<trimtab::TraceRow> rows;
  session.takeRows(rows, true);
  const auto written = trace->write(rows), closed = trace->finish();
  return written && closed ? 0 : refused(closed.findings());
}
