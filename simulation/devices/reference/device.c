/* SPDX-FileCopyrightText: 2026 The HIROSCO developers
 * SPDX-License-Identifier: Apache-2.0
 *
 * The reference device: an axis with a brake that keeps the duties of docs/guide/your_device.md, in C11 and POSIX alone. To copy from.
 *   device udp 127.0.0.1:5000 | device tcp 127.0.0.1:5000 | device serial NAME     (NAME: a link to the pseudo-terminal that it makes)
 * Command: velocity wanted. Status: position, velocity. Each change of its output is a line on standard output. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

enum { HEAD = 20, FRAME_MAX = 1024, STREAM_HEAD = 6, DOUBLES = 2 };
enum { OFF, ACTIVE, STOP, TRIPPED = 1, OLD_EPOCH = 2 };  /* modes of a command, flags of a status */
enum { IS_OFF, IS_ACTIVE, IS_STOPPING, IS_HOLDING };     /* what it does */
static const char *const names[] = {"off", "active", "stopping", "holding"};
static const int64_t cycle_ns = 1000000, stop_ns = 100000000, default_watchdog_ns = 10000000, longest_watchdog_ns = 1000000000;

static struct {
  uint32_t epoch, sequence;
  uint16_t flags;
  int mode, output, heard;
  int64_t watchdog_at, stop_end;
  double wanted, position, velocity, before_stop;
} axis;

static int64_t now_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * INT64_C(1000000000) + t.tv_nsec;
}

/* Little-endian numbers, whatever the machine. */
static uint64_t get(const uint8_t *at, int octets) {
  uint64_t value = 0;
  while (octets-- > 0) value = value << 8 | at[octets];
  return value;
}
static void put(uint8_t *at, int octets, uint64_t value) {
  for (int i = 0; i < octets; ++i, value >>= 8) at[i] = (uint8_t)value;
}
static uint16_t crc16(const uint8_t *at, size_t octets) { /* CRC-16/CCITT-FALSE */
  uint16_t crc = 0xFFFF;
  for (size_t i = 0; i < octets; ++i) {
    crc ^= (uint16_t)(at[i] << 8);
    for (int bit = 0; bit < 8; ++bit) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
  }
  return crc;
}

/* Duty 3: the watchdog is the device's own, and what it took away it does not give back. */
static void watch(int64_t now) {
  if (axis.mode != OFF && now >= axis.watchdog_at) axis.flags |= TRIPPED;
}

/* Whether the frame was a command, which is answered then (duty 1). */
static int take(const uint8_t *frame, size_t octets, int64_t now) {
  if (octets < HEAD + 2 || get(frame, 2) != 0x4844 || frame[2] != 1 || frame[3] > STOP) return 0;
  size_t payload = get(frame + 14, 2);
  if (octets != HEAD + payload + 2 || payload != sizeof(double) || get(frame + octets - 2, 2) != crc16(frame, octets - 2)) return 0;
  uint32_t epoch = (uint32_t)get(frame + 4, 4);
  if (epoch < axis.epoch) return axis.flags |= OLD_EPOCH, 1; /* duty 2: who was fenced and goes on is not obeyed */
  watch(now); /* before a late command can hide it */
  axis.flags &= (uint16_t)~OLD_EPOCH;
  if (epoch > axis.epoch) axis.flags &= (uint16_t)~TRIPPED; /* duty 4: the latch opens for a higher epoch alone */
  axis.epoch = epoch, axis.sequence = (uint32_t)get(frame + 8, 4), axis.mode = frame[3];
  if (!axis.heard && axis.mode == ACTIVE) axis.flags |= TRIPPED; /* and who begins is let go: no motion goes on by itself after a reboot */
  axis.heard = 1;
  uint64_t bits = get(frame + HEAD, 8);
  double wanted = 0;
  memcpy(&wanted, &bits, sizeof wanted);
  if (axis.mode == ACTIVE && wanted >= -10 && wanted <= 10) axis.wanted = wanted; /* what is no number is neither */
  int64_t watchdog = (int64_t)get(frame + 16, 4) * 1000;
  axis.watchdog_at = now + (watchdog == 0 ? default_watchdog_ns : watchdog < longest_watchdog_ns ? watchdog : longest_watchdog_ns);
  return 1;
}

static size_t status(uint8_t *frame) {
  double values[DOUBLES] = {axis.position, axis.velocity};
  put(frame, 2, 0x4844), frame[2] = 2, frame[3] = 0;
  put(frame + 4, 4, axis.epoch), put(frame + 8, 4, axis.sequence), put(frame + 12, 2, axis.flags);
  put(frame + 14, 2, sizeof values), put(frame + 16, 4, 0);
  for (int i = 0; i < DOUBLES; ++i) {
    uint64_t bits;
    memcpy(&bits, &values[i], sizeof bits);
    put(frame + HEAD + 8 * i, 8, bits);
  }
  put(frame + HEAD + sizeof values, 2, crc16(frame, HEAD + sizeof values));
  return HEAD + sizeof values + 2;
}

/* Duty 5: whatever took the command away, the stop is the device's own and ends at rest. */
static void step(int64_t now) {
  int before = axis.output;
  watch(now);
  if (axis.mode == ACTIVE && !(axis.flags & TRIPPED)) axis.output = IS_ACTIVE, axis.velocity = axis.wanted;
  else if (axis.output == IS_ACTIVE) axis.output = IS_STOPPING, axis.stop_end = now + stop_ns, axis.before_stop = axis.velocity;
  if (axis.output == IS_STOPPING) {
    double left = (double)(axis.stop_end - now) / (double)stop_ns;
    axis.velocity = left > 0 ? axis.before_stop * left : 0;
    if (left <= 0) axis.output = IS_HOLDING, axis.wanted = 0;
  }
  axis.position += axis.velocity * 1e-9 * (double)cycle_ns;
  if (axis.output == before) return;
  printf("%lld %s epoch %u flags %u position %.4f velocity %.4f\n", (long long)now, names[axis.output], axis.epoch, axis.flags, axis.position, axis.velocity);
  fflush(stdout);
}

/* --- the wire: datagrams are frames, in a stream each has sync, length and two checks (docs/interfaces/devices.md) --- */
static int wire = -1, listener = -1, datagrams;
static struct sockaddr_in peer; /* of datagrams: who sent last */
static uint8_t stream[2 * (FRAME_MAX + STREAM_HEAD + 2)];
static size_t filled; /* of the stream */

static void answer(void) {
  uint8_t out[FRAME_MAX];
  size_t octets = status(out + STREAM_HEAD);
  put(out, 2, 0x5348), put(out + 2, 2, octets), put(out + 4, 2, crc16(out, 4));
  put(out + STREAM_HEAD + octets, 2, crc16(out + STREAM_HEAD, octets));
  /* Duty 6: it waits for nobody: what does not go out at once is let go. */
  if (datagrams) sendto(wire, out + STREAM_HEAD, octets, MSG_DONTWAIT, (struct sockaddr *)&peer, sizeof peer);
  else if (write(wire, out, STREAM_HEAD + octets + 2) < 0 && errno != EAGAIN) return;
}

static void take_stream(int64_t now) {
  size_t at = 0;
  while (filled - at >= STREAM_HEAD) {
    size_t octets = get(stream + at + 2, 2);
    if (get(stream + at, 2) != 0x5348 || octets > FRAME_MAX || get(stream + at + 4, 2) != crc16(stream + at, 4)) {
      ++at; /* duty 7: after damage it finds its place again */
      continue;
    }
    if (filled - at < STREAM_HEAD + octets + 2) break;
    const uint8_t *frame = stream + at + STREAM_HEAD;
    int whole = get(frame + octets, 2) == crc16(frame, octets);
    at += whole ? STREAM_HEAD + octets + 2 : STREAM_HEAD;
    if (whole && take(frame, octets, now)) answer();
  }
  memmove(stream, stream + at, filled -= at);
}

static void receive(int64_t now) {
  if (listener >= 0) {
    int next = accept4(listener, NULL, NULL, SOCK_NONBLOCK);
    if (next >= 0) close(wire), wire = next, filled = 0; /* who comes last is the one */
  }
  for (int reads = 0; reads < 16 && wire >= 0; ++reads) { /* bounded, whoever floods it */
    uint8_t frame[FRAME_MAX + 1];
    socklen_t length = sizeof peer;
    ssize_t octets = datagrams ? recvfrom(wire, frame, sizeof frame, MSG_DONTWAIT, (struct sockaddr *)&peer, &length)
                               : read(wire, stream + filled, sizeof stream - filled);
    if (octets == 0 && listener >= 0) close(wire), wire = -1; /* hung up: the watchdog knows what to do */
    if (octets <= 0) return;
    if (datagrams) {
      if (take(frame, (size_t)octets, now)) answer();
    } else filled += (size_t)octets, take_stream(now);
  }
}

static int open_wire(const char *kind, char *address) {
  if (strcmp(kind, "serial") == 0) {
    struct termios raw;
    wire = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (wire < 0 || grantpt(wire) != 0 || unlockpt(wire) != 0 || tcgetattr(wire, &raw) != 0) return 0;
    cfmakeraw(&raw); /* whoever opens it knows by this that it is no terminal of somebody's */
    return tcsetattr(wire, TCSANOW, &raw) == 0 && (unlink(address), symlink(ptsname(wire), address) == 0);
  }
  char *colon = strrchr(address, ':');
  struct sockaddr_in own = {.sin_family = AF_INET};
  if (colon == NULL) return 0;
  *colon = 0, own.sin_port = htons((uint16_t)atoi(colon + 1));
  datagrams = strcmp(kind, "udp") == 0;
  int made = socket(AF_INET, (datagrams ? SOCK_DGRAM : SOCK_STREAM) | SOCK_NONBLOCK, 0), on = 1;
  setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  *(datagrams ? &wire : &listener) = made;
  return inet_pton(AF_INET, address, &own.sin_addr) == 1 && bind(made, (struct sockaddr *)&own, sizeof own) == 0 && (datagrams || listen(made, 1) == 0);
}

int main(int argc, char **argv) {
  if (argc != 3 || !open_wire(argv[1], argv[2])) return fprintf(stderr, "device udp|tcp HOST:PORT, or device serial NAME\n"), 1;
  signal(SIGPIPE, SIG_IGN);
  for (int64_t due = now_ns();;) {
    struct pollfd looked[2] = {{.fd = wire, .events = POLLIN}, {.fd = listener, .events = POLLIN}};
    int64_t rest = due - now_ns();
    struct timespec wait = {.tv_nsec = rest > 0 ? rest : 0};
    if (ppoll(looked, 2, &wait, NULL) > 0 && !((looked[0].revents | looked[1].revents) & POLLIN)) nanosleep(&wait, NULL); /* a line that nobody has open */
    receive(now_ns());
    for (; due <= now_ns(); due += cycle_ns) step(due);
  }
}
