// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A subsystem in C11 without a header of the project, written from docs/interfaces alone: a lamp that follows a pendulum. It requires a
// set, provides one and has a device. What its descriptor (lantern.xml) declares is built in. One thread does both loops, at 100 Hz.
#define _GNU_SOURCE
#include "lantern_services.h"

#include <math.h>
#include <stdlib.h>

// --- services ------------------------------------------------------------------------------------------------------------

static int list_is_bad(const request* of, const uint8_t* data, size_t size, size_t each) {
  if (size < 1 || size != 1 + data[0] * each) return fail(of, 2, 8, NULL, 0), 1;
  if (data[0] == 0) return fail(of, 2, 9, (uint8_t[]){0, 0}, 2), 1;
  return 0;
}
static void end_instructions(const request* of, int good, int count) {
  if (good == count) done(of, 7);
  else if (good > 0) fail(of, 8, 0x0201, (uint8_t[]){(uint8_t)good, (uint8_t)(count - good)}, 2);
}

static void test(const request* of, uint8_t subtype, size_t size) {
  if (subtype != 1) return fail(of, 2, 7, (uint8_t[]){17, subtype}, 2);
  if (size) return fail(of, 2, 8, NULL, 0);
  done(of, 1), done(of, 3);
  report(17, 2, of->source, NULL, 0);
  done(of, 7);
}

static void event_service(const request* of, uint8_t subtype, const uint8_t* data, size_t size) {
  if (subtype < 5 || subtype > 7) return fail(of, 2, 7, (uint8_t[]){5, subtype}, 2);
  if (subtype == 7) {
    uint8_t told[64] = {0};
    if (size) return fail(of, 2, 8, NULL, 0);
    for (int i = 0; i < event_count; ++i)
      if (disabled_[i]) put16(told + 1 + 2 * told[0]++, events_[i]);
    done(of, 1), done(of, 3);
    report(5, 8, of->source, told, 1 + 2 * (size_t)told[0]);
    return done(of, 7);
  }
  if (list_is_bad(of, data, size, 2)) return;
  done(of, 1);
  int good = 0;
  for (int i = 0; i < data[0]; ++i) {
    uint16_t id = u16(data + 1 + 2 * i);
    if (event_place(id) < 0) fail_at(of, 0x0101, (uint8_t)i, id);
    else ++good;
  }
  if (good == data[0]) done(of, 3);
  for (int i = 0; i < data[0]; ++i) {
    int place = event_place(u16(data + 1 + 2 * i));
    if (place >= 0) disabled_[place] = subtype == 6;
  }
  end_instructions(of, good, data[0]);
}

static void get_parameters(const request* of, const uint8_t* data, size_t size) {
  if (list_is_bad(of, data, size, 4)) return;
  done(of, 1);
  uint8_t told[4096] = {0};
  size_t at = 1;
  for (int i = 0; i < data[0]; ++i) {
    int place = parameter_of(u32(data + 1 + 4 * i));
    if (place < 0) {
      fail_at(of, 0x0101, (uint8_t)i, u32(data + 1 + 4 * i));
      continue;
    }
    put32(told + at, wire(place));
    at += 4 + put_parameter(told + at + 4, place);
    ++told[0];
  }
  if (told[0] == data[0]) done(of, 3);
  if (told[0]) report(20, 2, of->source, told, at);
  end_instructions(of, told[0], data[0]);
}

static void set_parameters(const request* of, const uint8_t* data, size_t size) {
  if (size < 1) return fail(of, 2, 8, NULL, 0);
  if (data[0] == 0 && size == 1) return fail(of, 2, 9, (uint8_t[]){0, 0}, 2);
  size_t at = 1;
  for (int i = 0; i < data[0]; ++i) {
    if (at + 4 > size) return fail(of, 2, 8, NULL, 0);
    int place = parameter_of(u32(data + at));
    if (place < 0) return done(of, 1), fail_at(of, 0x0101, (uint8_t)i, u32(data + at));
    at += 4 + octets_of(place);
  }
  if (at != size) return fail(of, 2, 8, NULL, 0);
  done(of, 1);
  int bad = 0;
  at = 1;
  float wanted = brightness_;
  for (int i = 0; i < data[0]; ++i) {
    int place = parameter_of(u32(data + at));
    float value = get_float(data + at + 4);
    int writable = place == 3 && state_ >= 3 && state_ <= 5;
    if (!writable) fail_at(of, 0x0107, (uint8_t)i, u32(data + at)), bad = 1;
    else if (!(value >= 0 && value <= 2)) fail_at(of, 0x0105, (uint8_t)i, u32(data + at)), bad = 1;
    else wanted = value;
    at += 4 + octets_of(place);
  }
  if (bad) return;
  if (configured_) wanted_brightness_ = wanted, write_waits_ = 1;
  else brightness_ = wanted;
  done(of, 3), done(of, 7);
}

static void function(const request* of, uint8_t subtype, const uint8_t* data, size_t size) {
  if (subtype != 1) return fail(of, 2, 7, (uint8_t[]){8, subtype}, 2);
  if (size < 17) return fail(of, 2, 8, NULL, 0);
  static const struct {
    char name[17];
    uint8_t least, most;
  } known[] = {{"SET_STATE", 0, 9}, {"CONFIGURE", 0, 255}, {"FLASH", 1, 5}};
  int which = -1;
  for (int i = 0; i < 3; ++i)
    if (!memcmp(data, known[i].name, 16)) which = i;
  if (which < 0) {
    uint8_t why[17] = {0};
    memcpy(why + 1, data, 16);
    done(of, 1);
    return fail(of, 4, 0x0101, why, 17);
  }
  // Each has one argument of one octet with the id 1.
  int count = data[16], first = -1, taken = 0;
  size_t at = 17;
  for (int i = 0; i < count; ++i, at += 2) {
    if (at >= size) return fail(of, 2, 8, NULL, 0);
    if (data[at] != 1) return done(of, 1), fail_at(of, 0x0105, (uint8_t)(first >= 0 ? first : i), first >= 0 ? 1 : data[at]);
    if (at + 2 > size) return fail(of, 2, 8, NULL, 0);
    if ((taken++ || data[at + 1] < known[which].least || data[at + 1] > known[which].most) && first < 0) first = i;
  }
  if (at != size) return fail(of, 2, 8, NULL, 0);
  done(of, 1);
  if (first >= 0 || !taken) return fail_at(of, 0x0105, (uint8_t)(first >= 0 ? first : count), 1);
  if (which == 0) return set_state(of, data[18]);
  if (which == 1) return configure(of, data[18]);
  if (state_ != 5 || !configured_ || way_size_ > 0) return fail_state(of, 4);
  if (calls_size_ == 16) return fail(of, 4, 11, NULL, 0);
  calls_[calls_size_].from = *of;
  calls_[calls_size_++].times = data[18];
}

static void housekeeping(const request* of, uint8_t subtype, const uint8_t* data, size_t size) {
  if (!configured_) return fail_state(of, 2);
  int knows = subtype == 5 || subtype == 6 || subtype == 9 || subtype == 27 || subtype == 31 || subtype == 33;
  if (!knows) return fail(of, 2, 7, (uint8_t[]){3, subtype}, 2);
  size_t each = subtype == 31 ? 6 : 2;
  if (list_is_bad(of, data, size, each)) return;
  done(of, 1);
  int good = 0;
  for (int i = 0; i < data[0]; ++i) {
    uint16_t id = u16(data + 1 + each * (size_t)i);
    if (id != fixed_id) fail_at(of, 0x0101, (uint8_t)i, id);
    else if (subtype == 31 && u32(data + 3 + each * (size_t)i) == 0) fail_at(of, 0x0105, (uint8_t)i, id);
    else ++good;
  }
  if (good == data[0]) done(of, 3);
  uint8_t told[2048] = {(uint8_t)good};
  size_t at = 1;
  for (int i = 0; i < data[0]; ++i) {
    if (u16(data + 1 + each * (size_t)i) != fixed_id) continue;
    uint8_t head[20];
    put16(head, fixed_id);
    head[2] = (uint8_t)structure_.on;
    put32(head + 3, structure_.interval);
    if (subtype == 5 && !structure_.on) structure_.on = 1, structure_.phase = 0;
    if (subtype == 6) structure_.on = 0;
    if (subtype == 27) ++structure_.once_more;
    if (subtype == 31 && u32(data + 3 + each * (size_t)i) != 0) structure_.interval = u32(data + 3 + each * (size_t)i);
    if (subtype == 33) memcpy(told + at, head, 7), at += 7;
    if (subtype == 9) head[7] = 2, put32(head + 8, wire(0)), put32(head + 12, wire(3)), head[16] = 0, report(3, 10, of->source, head, 17);
  }
  if (subtype == 33 && good) report(3, 35, of->source, told, at);
  end_instructions(of, good, data[0]);
}

static void telecommand(const uint8_t* packet, size_t size, uint32_t mode_epoch, int memory) {
  if (size < 6) return;
  uint16_t identification = u16(packet), length = u16(packet + 4);
  if (identification >> 13 || !(identification & 0x1000) || (identification & 0x7FF) == 0x7FF) return;
  request of = {.source = 0};
  memcpy(of.id, packet, 4);
  if (size < 13 || length != size - 7) return fail(&of, 2, 2, packet + 4, 2);
  if (!(identification & 0x0800)) return fail(&of, 2, 3, NULL, 0);
  if (packet[2] >> 6 != 3) return fail(&of, 2, 12, NULL, 0);
  if (crc16(packet, size) != 0) return fail(&of, 2, 5, NULL, 0);
  if (packet[6] >> 4 != 2) return fail(&of, 2, 4, NULL, 0);
  of.source = u16(packet + 9), of.ack = packet[6] & 15;
  if ((identification & 0x7FF) != apid_) return fail(&of, 10, 1, NULL, 0);
  if (mode_epoch != 0 && mode_epoch != load32(permit_ + 24)) return fail(&of, 2, 13, NULL, 0);
  const uint8_t* data = packet + 11;
  size -= 13;
  switch (packet[7]) {
    case 3: return housekeeping(&of, packet[8], data, size);
    case 5: return event_service(&of, packet[8], data, size);
    case 8: return function(&of, packet[8], data, size);
    case 17: return test(&of, packet[8], size);
    case 20:
      if (packet[8] == 1) return get_parameters(&of, data, size);
      if (packet[8] == 3) return set_parameters(&of, data, size);
      return fail(&of, 2, 7, (uint8_t[]){20, packet[8]}, 2);
    case 128: return links(&of, packet[8], data, size, memory);
    default: return fail(&of, 2, 6, (uint8_t[]){packet[7]}, 1);
  }
}

/// Of a supervisor that goes on for one that died: sealed against shrinking, growing and other writers.
static int another_permit_page(int memory) {
  struct stat status;
  int seals = fcntl(memory, 1034);
  if (fstat(memory, &status) != 0 || status.st_size != 56 || seals < 0 || (seals & 0x16) != 0x16) return 0;
  void* at = mmap(NULL, 56, PROT_READ, MAP_SHARED, memory, 0);
  if (at == MAP_FAILED) return 0;
  const volatile uint8_t* page = at;
  if (load32(page) != 0x48495243 || load32(page + 4) != 8) return munmap(at, 56), 0;
  munmap((void*)(uintptr_t)permit_, 56);
  permit_ = page;
  heartbeat_ = load64(page + 32);
  return 1;
}

static void receive(void) {
  for (int left = 64; left > 0 && waiting_count_ < 512 && !lost_; --left) {
    uint8_t octets[4104];
    _Alignas(struct cmsghdr) char control[CMSG_SPACE(16 * sizeof(int))];
    struct iovec part = {octets, sizeof octets};
    struct msghdr head = {.msg_iov = &part, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control};
    ssize_t size = recvmsg(channel_, &head, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
    struct pollfd end = {channel_, POLLRDHUP, 0};
    if (size < 0 || (size == 0 && poll(&end, 1, 0) > 0)) lost_ = 1;
    int given[64], count = 0;
    for (struct cmsghdr* each = size < 0 ? NULL : CMSG_FIRSTHDR(&head); each; each = CMSG_NXTHDR(&head, each))
      if (each->cmsg_level == SOL_SOCKET && each->cmsg_type == SCM_RIGHTS)
        for (size_t at = 0; at + CMSG_LEN(0) < each->cmsg_len && count < 64; at += sizeof(int)) memcpy(&given[count++], CMSG_DATA(each) + at, sizeof(int));
    int good = !lost_ && size >= 8 && octets[0] == 1 && octets[1] == 1 && count <= 1 && !(head.msg_flags & (MSG_TRUNC | MSG_CTRUNC));
    static int told;
    if (size >= 8 && octets[1] != 1 && !told++) fprintf(stderr, "lantern: the supervisor's control channel is of version %d, this program's of version 1\n", octets[1]);
    if (!lost_ && size == 8 && octets[0] == 4 && octets[1] == 1 && count == 1 && another_permit_page(given[0])) put(4, NULL, 0);
    if (good) telecommand(octets + 8, (size_t)size - 8, u32(octets + 4), count ? given[0] : -1);
    while (count > 0) close(given[--count]);
  }
}

// --- the cycle -----------------------------------------------------------------------------------------------------------

static void inhibit(uint32_t why) { inhibited_ |= why; }

static void check_permit(void) {
  moves_ = permitted(permit_, &epoch_now_);
  if (load32(permit_ + 12) != 0 || (state_ == 5 && (epoch_now_ != entered_epoch_ || !moves_))) inhibit(stop_bit);
  if (silent_ > silence_real) inhibit(supervisor_bit);
  store32(vital_ + 20, epoch_now_);
}

static void listen_to_supervisor(void) {
  uint64_t heartbeat = load64(permit_ + 32);
  silent_ = heartbeat != heartbeat_ ? 0 : silent_ + 1;
  heartbeat_ = heartbeat;
  uint8_t cycles[4];
  put32(cycles, silent_);
  if (silent_ == silence_real + 1) event(0xF005, cycles, 4);
}

static void read_link(void) {
  static uint8_t payload[65536 + 8];
  static uint32_t status;
  uint64_t count = 0;
  int64_t at = 0;
  int attached = consumer_.words != NULL, is_new = attached && read_sample(&consumer_, payload, &status, &count, &at);
  if (is_new) {
    if (consumer_.count && count > consumer_.count + 1) store32(vital_ + 100, load32(vital_ + 100) + (uint32_t)(count - consumer_.count - 1));
    consumer_.count = count;
    size_t place = 0;
    for (int i = 0; i < consumer_.agreed.field_count; ++i) {
      const field* each = &consumer_.agreed.fields[i];
      if (has_field(each, 1, &pendulum_[0])) memcpy(swing_, payload + place, sizeof swing_);
      if (has_field(each, 1, &pendulum_[1])) memcpy(&seen_, payload + place, sizeof seen_);
      place += (size_t)octets_of_type(each->type) * each->count;
    }
    uint64_t late = (uint64_t)(now_ns() - at);
    if (late < 4000000000u && late > load32(vital_ + 108)) store32(vital_ + 108, (uint32_t)late);
    int64_t took = now_ns() - at;
    int bin = 0;  // number of bits of the 64ths of a period that it took, at most 8
    for (int64_t parts = took > 1 ? (took - 1) * 64 / (consumer_.agreed.producer_ns > 0 ? consumer_.agreed.producer_ns : 1) : 0; parts && bin < 8; parts >>= 1) ++bin;
    store32(vital_ + 2160 + 4 * bin, load32(vital_ + 2160 + 4 * bin) + 1);
  }
  age_ = is_new ? 0 : age_ + (age_ < 1000000000);
  fresh_ = attached && consumer_.count != 0 && age_ <= age_cycles * factor_ && (status == 1 || status == 2);
  int stale = (state_ == 4 || state_ == 5) && !fresh_;
  store32(vital_ + 4716, stale ? 2 : fresh_ ? 1 : 0);
  uint8_t age[4];
  put32(age, age_);
  if (stale) inhibit(link_bit);
  if (stale && !was_stale_ && attached && status != 3) event(0xF200, age, 4);
  was_stale_ = stale;
}

static uint32_t le32(const uint8_t* at) { return (uint32_t)at[3] << 24 | (uint32_t)at[2] << 16 | (uint32_t)at[1] << 8 | at[0]; }
static void put_le32(uint8_t* to, uint32_t value) {
  for (int i = 0; i < 4; ++i) to[i] = (uint8_t)(value >> 8 * i);
}

static void read_lamp(void) {
  uint8_t frame[1100];
  ssize_t size, newest = -1;
  uint8_t kept[1100];
  while ((size = recv(lamp_, frame, sizeof frame, MSG_DONTWAIT)) >= 0) memcpy(kept, frame, (size_t)size), newest = size;
  int news = 0;
  if (newest >= 0) {
    uint16_t sum = newest >= 2 ? (uint16_t)(kept[newest - 1] << 8 | kept[newest - 2]) : 0;
    int intact = newest >= 22 && kept[0] == 0x44 && kept[1] == 0x48 && sum == crc16(kept, (size_t)newest - 2);
    if (intact && kept[2] != 1 && kept[2] != 2) ++other_;
    else if (!intact || kept[2] != 2 || newest != 22 + (kept[14] | kept[15] << 8)) ++damaged_;
    else if (newest != 26) ++wrong_;
    else {
      news = !heard_ || le32(kept + 8) != echoed_;
      repeated_ += !news;
      echoed_ = le32(kept + 8);
    }
  }
  int controls = state_ == 4 || state_ == 5;
  if (news) heard_ = lamp_alive_ = 1, quiet_ = damaged_ = wrong_ = repeated_ = other_ = 0;
  else if (heard_ || controls) ++quiet_;
  if (!news && quiet_ == silence_cycles && (lamp_alive_ || !heard_)) {
    uint32_t most = 0;
    uint8_t why[13] = {1};  // nothing came
    if (damaged_ > most) most = damaged_, why[0] = 3;
    if (wrong_ > most) most = wrong_, why[0] = 4;
    if (other_ > most) most = other_, why[0] = 10;
    if (repeated_ > most) most = repeated_, why[0] = 5;
    put32(why + 1, quiet_), put32(why + 5, damaged_), put32(why + 9, wrong_);
    lamp_alive_ = 0;
    event(0xF100, why, 13);
  }
  if (controls && !lamp_alive_) inhibit(device_bit);
}

static void write_lamp(void) {
  int active = state_ == 5 && inhibited_ == 0;
  float power = active ? glow_ : 0.25f;
  if (!(power >= 0)) power = 0.25f;
  if (power > 5) power = 5;
  uint16_t colour = active ? 3 : 7;
  uint8_t frame[28] = {0x44, 0x48, 1, active ? 1 : state_ == 6 ? 2 : 0};
  put_le32(frame + 4, epoch_now_), put_le32(frame + 8, ++sequence_);
  frame[14] = 6;
  put_le32(frame + 16, 200000);
  uint32_t bits;
  memcpy(&bits, &power, 4);
  put_le32(frame + 20, bits);
  frame[24] = (uint8_t)colour, frame[25] = (uint8_t)(colour >> 8);
  uint16_t sum = crc16(frame, 26);
  frame[26] = (uint8_t)sum, frame[27] = (uint8_t)(sum >> 8);
  struct sockaddr_un to = {.sun_family = AF_UNIX};
  snprintf(to.sun_path, sizeof to.sun_path, "%s", address_);
  (void)!sendto(lamp_, frame, sizeof frame, MSG_DONTWAIT | MSG_NOSIGNAL, (struct sockaddr*)&to, sizeof to);
}

static void enter_state(void) {
  if (way_size_ == 0) return;
  if (way_[way_at_] == 5) {
    entered_epoch_ = epoch_now_;
    inhibited_ = moves_ && load32(permit_ + 12) == 0 ? 0 : stop_bit;
  }
  arrive(way_[way_at_]);
  advance();
}

static void sample(void) {
  uint8_t data[32];
  put16(data, fixed_id);
  put_parameter(data + 2, 0), put_parameter(data + 10, 3);
  if (structure_.on && ++structure_.phase >= structure_.interval) structure_.phase = 0, report(3, 25, 0, data, 14);
  if (structure_.once_more > 0) --structure_.once_more, report(3, 25, 0, data, 14);
}

static void cycle(void) {
  int64_t started = now_ns(), planned = next_ns_;
  uint32_t before = inhibited_;
  listen_to_supervisor();
  check_permit();
  if (write_waits_) brightness_ = wanted_brightness_, write_waits_ = 0;
  enter_state();
  for (int i = 0; i < calls_size_; ++i) done(&calls_[i].from, 3), done(&calls_[i].from, 7);
  calls_size_ = 0;
  if (!configured_) return;
  read_link();
  read_lamp();
  if (state_ == 4 || state_ == 5) glow_ = brightness_ * (float)fabs(swing_[0]);
  write_lamp();
  uint8_t payload[8];
  uint32_t bits;
  memcpy(&bits, &glow_, 4);
  put_le32(payload, bits), put_le32(payload + 4, seen_);
  uint32_t status = state_ == 6 || (inhibited_ & device_bit) ? 4 : inhibited_ ? 2 : 1;
  for (int i = 0; i < max_links; ++i)
    if (producers_[i].words) write_sample(&producers_[i], payload, planned, status);
  sample();
  int64_t finished = now_ns();
  if (started - planned > load32(vital_ + 72)) store32(vital_ + 72, (uint32_t)(started - planned));
  if (finished - started > load32(vital_ + 76)) store32(vital_ + 76, (uint32_t)(finished - started));
  if (inhibited_ && !before) store64(vital_ + 88, load64(vital_ + 40) + 1);
  store32(vital_ + 16, inhibited_);
  store64(vital_ + 40, load64(vital_ + 40) + 1);
  next_ns_ = planned + period_ns;
  if (finished <= next_ns_) return;
  int64_t skipped = (finished - next_ns_) / period_ns + 1;
  store64(vital_ + 64, load64(vital_ + 64) + (uint64_t)skipped);
  next_ns_ += skipped * period_ns;
}

static void watch_supervisor(void) {
  if (state_ == 5 && (lost_ || (silent_ > silence_real && way_size_ == 0))) inhibit(supervisor_bit), go(6, NULL);
  else if (lost_ && way_size_ == 0 && state_ == 0) finished_ = 1;
  else if (lost_ && way_size_ == 0) go(0, NULL);
}

// --- the process ---------------------------------------------------------------------------------------------------------

static int change(const char* word, const char* text) {
  char device[32];
  unsigned id;
  if (!strcmp(word, "--as") && sscanf(text, "%31[^:]:%u", name_, &id) == 2) return apid_ = (uint16_t)id, 1;
  if (!strcmp(word, "--set") && sscanf(text, "BRIGHTNESS=%f", &first_brightness_) == 1) return 1;
  return !strcmp(word, "--address") && sscanf(text, "%31[^=]=%107s", device, address_) == 2 && !strcmp(device, "LAMP");
}

static volatile uint8_t* page(const char* number, size_t octets, int writable) {
  struct stat status;
  int memory = atoi(number);
  if (fstat(memory, &status) != 0 || (size_t)status.st_size < octets) return NULL;
  void* at = mmap(NULL, octets, writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, memory, 0);
  close(memory);
  return at == MAP_FAILED ? NULL : at;
}

int main(int argc, char** argv) {
  const char *descriptor = NULL, *channel = NULL, *vital = NULL, *permit = NULL;
  signal(SIGPIPE, SIG_IGN);
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!strcmp(argv[i], "--descriptor")) descriptor = argv[i + 1];
    else if (!strcmp(argv[i], "--channel")) channel = argv[i + 1];
    else if (!strcmp(argv[i], "--vital")) vital = argv[i + 1];
    else if (!strcmp(argv[i], "--permit")) permit = argv[i + 1];
    else if (!strcmp(argv[i], "--text")) close(atoi(argv[i + 1]));  /* what it says is built in here */
    else if (!change(argv[i], argv[i + 1])) return fprintf(stderr, "lantern: nothing here for %s %s\n", argv[i], argv[i + 1]), 3;
  }
  if (!descriptor || !channel || !vital || !permit)
    return fprintf(stderr, "lantern: the supervisor starts it: --descriptor FILE --channel FD --vital FD --permit FD\n"), 2;
  channel_ = atoi(channel);
  vital_ = page(vital, 4976, 1), permit_ = page(permit, 56, 0);
  if (!vital_ || !permit_ || load32(vital_) != 0x48495243 || load32(permit_) != 0x48495243)
    return fprintf(stderr, "lantern: what should be the supervisor's pages are none\n"), 3;
  if (load32(vital_ + 4) != 8 || load32(permit_ + 4) != 8)
    return fprintf(stderr, "lantern: the supervisor's pages are of version %u, this program's of version 8\n", load32(permit_ + 4)), 3;
  const char* instance = getenv("HIROSCO_INSTANCE");
  size_t named = strlen(address_);
  if (instance && *instance) snprintf(address_ + named, sizeof address_ - named, ".%s", instance);
  const char* epoch = getenv("HIROSCO_EPOCH_NS");
  epoch_ns_ = epoch ? atoll(epoch) : clock_ns(CLOCK_REALTIME) - now_ns() + (378691200LL + 37) * 1000000000;
  store_checked(vital_ + 24, 0);
  while (!finished_) {
    store64(vital_ + 48, load64(vital_ + 48) + 1);
    if (configured_ && now_ns() >= next_ns_) cycle();
    int64_t due = configured_ ? next_ns_ - now_ns() : 10000000;
    due = due < 0 ? 0 : due > 10000000 ? 10000000 : due;
    struct timespec rest = {0, (long)due};
    struct pollfd readable = {lost_ ? -1 : channel_, POLLIN, 0};
    ppoll(&readable, 1, &rest, NULL);
    receive();
    watch_supervisor();
    flush();
  }
  return 0;
}
