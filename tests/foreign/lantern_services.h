// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What lantern.c is and says: its state, links, ways. Written from docs/interfaces alone.
#pragma once
#include "lantern_wire.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <sys/un.h>

enum { max_links = 8, parameters = 4, period_ns = 10000000, age_cycles = 10, silence_cycles = 20, silence_real = 2000000000 / period_ns };
enum { fixed_id = 6110, stop_bit = 1, link_bit = 2, device_bit = 4, supervisor_bit = 32 };

typedef struct {
  uint8_t id[4];
  uint16_t source;
  uint8_t ack;
} request;

static char name_[32] = "LANTERN", address_[108] = "foreign-lamp";
static uint16_t apid_ = 61;
static int channel_ = -1, lamp_ = -1, state_, configured_, lost_, finished_, disabled_[8];
static volatile uint8_t* vital_;
static const volatile uint8_t* permit_;
static int64_t epoch_ns_, next_ns_;
static float first_brightness_ = 1, brightness_, glow_;
static uint32_t seen_, epoch_now_, entered_epoch_, inhibited_, silent_, sequence_, echoed_;
static uint64_t heartbeat_;
static int moves_, way_[5], way_size_, way_at_, has_way_request_;
static request way_request_;
static link_end consumer_, producers_[max_links];
static uint32_t age_, factor_;
static int fresh_, was_stale_, heard_, lamp_alive_, told_lost_;
static uint32_t quiet_, damaged_, wrong_, repeated_, other_;
static double swing_[2];
static struct {
  request from;
  uint8_t times;
} calls_[16];
static int calls_size_;
static struct {
  int on, once_more;
  uint32_t interval, phase;
} structure_;
static float wanted_brightness_;
static int write_waits_;
static struct {
  size_t octets;
  uint8_t message[4200];
} waiting_[1024];
static size_t first_waiting_, waiting_count_;

static const uint16_t events_[] = {0xF000, 0xF001, 0xF002, 0xF003, 0xF005, 0xF100, 0xF200};
static const uint8_t severities_[] = {1, 4, 2, 3, 2, 4, 3};
enum { event_count = 7 };

// --- what it says ------------------------------------------------------------------------------------------------------

static void flush(void) {
  while (waiting_count_ > 0) {
    if (send(channel_, waiting_[first_waiting_].message, waiting_[first_waiting_].octets, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
      if (errno == EAGAIN || errno == ENOBUFS) return;
      waiting_count_ = 0;
      return;
    }
    first_waiting_ = (first_waiting_ + 1) % 1024;
    --waiting_count_;
  }
}

static void put(uint8_t kind, const uint8_t* octets, size_t size) {
  if (waiting_count_ == 1024) return;
  size_t at = (first_waiting_ + waiting_count_++) % 1024;
  memset(waiting_[at].message, 0, 8);
  waiting_[at].message[0] = kind;
  waiting_[at].message[1] = 1;
  if (size > 0) memcpy(waiting_[at].message + 8, octets, size);
  waiting_[at].octets = 8 + size;
  flush();
}

static void report(uint8_t service, uint8_t subtype, uint16_t destination, const uint8_t* data, size_t size) {
  uint8_t packet[4096];
  uint16_t sequence, count;
  stamp(vital_, destination, service, subtype, &sequence, &count);
  put16(packet, 0x0800 | apid_);
  put16(packet + 2, 0xC000 | sequence);
  put16(packet + 4, (uint16_t)(size + 15));
  packet[6] = 0x20;
  packet[7] = service;
  packet[8] = subtype;
  put16(packet + 9, count);
  put16(packet + 11, destination);
  int64_t now = now_ns() + epoch_ns_;
  put32(packet + 13, (uint32_t)(now / 1000000000));
  uint32_t fraction = (uint32_t)(((uint64_t)(now % 1000000000) << 24) / 1000000000);
  packet[17] = (uint8_t)(fraction >> 16);
  put16(packet + 18, (uint16_t)fraction);
  memcpy(packet + 20, data, size);
  put16(packet + 20 + size, crc16(packet, 20 + size));
  put(1, packet, 22 + size);
}

static void verify(const request* of, uint8_t subtype, const uint8_t* data, size_t size) {
  int flag = subtype == 1 ? 1 : subtype == 3 ? 2 : subtype == 7 ? 8 : 0;
  if (flag && !(of->ack & flag)) return;
  uint8_t all[64];
  memcpy(all, of->id, 4);
  if (size) memcpy(all + 4, data, size);
  report(1, subtype, of->source, all, 4 + size);
}
static void done(const request* of, uint8_t subtype) { verify(of, subtype, NULL, 0); }

static void fail(const request* of, uint8_t subtype, uint16_t code, const uint8_t* data, size_t size) {
  uint8_t all[32];
  put16(all, code);
  if (size) memcpy(all + 2, data, size);
  verify(of, subtype, all, 2 + size);
}
static void fail_at(const request* of, uint16_t code, uint8_t index, uint32_t id) {
  uint8_t data[5] = {index};
  put32(data + 1, id);
  fail(of, 4, code, data, 5);
}
static void fail_state(const request* of, uint8_t subtype) { fail(of, subtype, 10, (uint8_t[]){(uint8_t)state_}, 1); }

static int event_place(uint16_t id) {
  for (int i = 0; i < event_count; ++i)
    if (events_[i] == id) return i;
  return -1;
}
static void event(uint16_t id, const uint8_t* data, size_t size) {
  int place = event_place(id);
  uint8_t all[64] = {severities_[place], disabled_[place] ? 0 : 1};
  put16(all + 2, id);
  memcpy(all + 4, data, size);
  put(3, all, 4 + size);
  if (!disabled_[place]) report(5, severities_[place], 0, all + 2, 2 + size);
}

// --- parameters: LIGHT, its GLOW and SEEN, BRIGHTNESS ------------------------------------------------------------------------

static uint32_t wire(int i) {
  static const uint8_t types[] = {32, 9, 5, 9}, ids[] = {0, 0, 0, 1};
  return (uint32_t)apid_ << 16 | (uint32_t)types[i] << 8 | ids[i];
}
static int parameter_of(uint32_t id) {
  for (int i = 0; i < parameters && state_ != 0; ++i)
    if (wire(i) == id) return i;
  return -1;
}
static size_t octets_of(int i) { return i == 0 ? 8 : 4; }
static size_t put_parameter(uint8_t* to, int i) {
  if (i == 0) return put_float(to, glow_), put32(to + 4, seen_), 8;
  if (i == 2) return put32(to, seen_), 4;
  return put_float(to, i == 1 ? glow_ : brightness_), 4;
}

// --- links ---------------------------------------------------------------------------------------------------------------

static const field light_[] = {{"GLOW", 9, 1}, {"SEEN", 5, 1}};
static const field pendulum_[] = {{"POSITION", 10, 2}, {"BEAT", 5, 1}};

static void let_go(link_end* end, uint8_t role) {
  if (role == 1) tell_status(end, 3);
  uint8_t data[2] = {end->link, role};
  close_link(end);
  report(128, 133, 0, data, 2);
}

static void refuse_link(const request* of, uint8_t link, uint8_t item, const char* words) {
  uint8_t data[64] = {link, item, (uint8_t)strlen(words)};
  memcpy(data + 3, words, strlen(words));
  report(128, 131, of->source, data, 3 + strlen(words));
  fail(of, 4, 0x0107, (uint8_t[]){0}, 1);
}

static link_end* end_of(uint8_t link, uint8_t* role) {
  *role = 2;
  if (consumer_.words && consumer_.link == link) return &consumer_;
  *role = 1;
  for (int i = 0; i < max_links; ++i)
    if (producers_[i].words && producers_[i].link == link) return &producers_[i];
  return NULL;
}

static void offer(const request* of, uint8_t link) {
  uint8_t data[128] = {link};
  size_t at = 1 + put_string(data + 1, "PENDULUM");
  put64(data + at, period_ns);
  memcpy(data + at + 8, (uint8_t[]){1, 1, 1, 1, 1, 1, 0, 0, 0}, 9);
  at += 17;
  at += put_fields(data + at, pendulum_, 2);
  done(of, 3);
  report(128, 129, of->source, data, at);
  done(of, 7);
}

static void negotiate(const request* of, uint8_t link, const terms* theirs) {
  if (!theirs->has_memory) return refuse_link(of, link, 0, "method: producer shared_memory");
  if (!theirs->has_latest) return refuse_link(of, link, 2, "kind: producer latest");
  if (!theirs->has_little) return refuse_link(of, link, 1, "byte order: producer little");
  if (!theirs->wakes && period_ns % theirs->period && theirs->period % period_ns) return refuse_link(of, link, 3, "rate: producer 10 ms");
  for (int i = 0; i < theirs->field_count; ++i)
    if (!has_field(light_, 2, &theirs->fields[i])) return refuse_link(of, link, 4, "field: none such");
  uint8_t data[128] = {link, 1, 1, 1, 0, 0, (uint8_t)theirs->wakes};
  put64(data + 7, period_ns);
  put64(data + 15, (uint64_t)theirs->period);
  size_t at = 23 + put_fields(data + 23, light_, 2);
  done(of, 3);
  report(128, 130, of->source, data, at);
  done(of, 7);
}

static void attach(const request* of, uint8_t role, const char* set, const agreement* agreed, int memory) {
  uint8_t link = agreed->link, held = 0;
  link_end* earlier = end_of(link, &held);
  link_end* place = earlier;
  if (strcmp(set, role == 1 ? "LIGHT" : "PENDULUM")) return refuse_link(of, link, 4, "no such set");
  if (earlier && agreed->epoch <= earlier->epoch) return refuse_link(of, link, 0, "the link is attached already");
  if (role == 2 && !earlier && state_ != 3) return refuse_link(of, link, 0, "links are made in PreOperational");
  if (role == 2 && !earlier && consumer_.words) return refuse_link(of, link, 0, "the set has a link already");
  if (agreed->method != 1 || agreed->kind != 1 || agreed->order != 1) return refuse_link(of, link, 0, "other terms than agreed");
  for (int i = 0; role == 2 && i < 2; ++i)
    if (!has_field(agreed->fields, agreed->field_count, &pendulum_[i])) return refuse_link(of, link, 0, "a field is not there");
  for (int i = 0; role == 1 && i < 2; ++i)
    if (agreed->field_count != 2 || !has_field(&agreed->fields[i], 1, &light_[i])) return refuse_link(of, link, 0, "not of this set");
  for (int i = 0; role == 1 && !place && i < max_links; ++i)
    if (!producers_[i].words) place = &producers_[i];
  if (role == 2) place = &consumer_;
  if (!place) return refuse_link(of, link, 0, "too many links");
  link_end made;
  const char* why = role == 1 ? make_producer(&made, agreed, memory) : make_consumer(&made, agreed, memory);
  if (why) return refuse_link(of, link, 0, why);
  if (earlier) close_link(earlier);
  *place = made;
  if (role == 2) {
    age_ = 0;
    factor_ = agreed->producer_ns / period_ns > 1 ? (uint32_t)(agreed->producer_ns / period_ns) : 1;
    store32(vital_ + 96, link);
    store32(vital_ + 100, 0);
    for (int bin = 0; bin < 9; ++bin) store32(vital_ + 2160 + 4 * bin, 0);
    store32(vital_ + 2156, agreed->producer_ns < UINT32_MAX ? (uint32_t)agreed->producer_ns : UINT32_MAX);
  }
  done(of, 3);
  report(128, 132, of->source, (uint8_t[11]){link, role}, 11);  // it stands in memory: no address, no key
  done(of, 7);
}

/// Where an end stands: empty in memory.
static void pass_place(reader* in) {
  for (uint8_t left = get8(in); left > 0 && in->good; --left) get8(in);
}

static void links(const request* of, uint8_t subtype, const uint8_t* data, size_t size, int memory) {
  reader in = {data, size, 0, 1};
  char set[256];
  terms theirs;
  agreement agreed;
  uint8_t link = get8(&in), role = 0;
  if (subtype < 1 || subtype > 4) return fail(of, 2, 7, (uint8_t[]){128, subtype}, 2);
  if (subtype == 3) role = get8(&in), agreed.epoch = get32(&in), agreed.link = link, in.good = in.good && get32(&in) == 0;  // lent sets it has none
  if (subtype != 4) get_string(&in, set);
  if (subtype == 2) in.good = in.good && get8(&in) == link, get_offer(&in, &theirs);
  if (subtype == 3) in.good = in.good && (role == 1 || role == 2), get_agreement(&in, &agreed), pass_place(&in), pass_place(&in), get32(&in), get32(&in);
  if (!in.good || in.at != size) return fail(of, 2, 8, NULL, 0);
  done(of, 1);
  if (subtype == 4) {
    link_end* end = end_of(link, &role);
    if (!end) return fail_at(of, 0x0101, 0, link);
    if (role == 2) store32(vital_ + 96, 0);
    let_go(end, role);
    done(of, 3);
    return done(of, 7);
  }
  int here = configured_ && state_ >= 3 && state_ <= 6;
  if (subtype == 3) {
    if (!here) return refuse_link(of, link, 4, "no configuration in force");
    return attach(of, role, set, &agreed, memory);
  }
  if (!here || strcmp(set, subtype == 1 ? "PENDULUM" : "LIGHT")) return refuse_link(of, link, 4, "no configuration in force has this set");
  if (subtype == 2) return negotiate(of, link, &theirs);
  if (consumer_.words && consumer_.link != link) return refuse_link(of, link, 4, "the set has a link already");
  if (state_ != 3 && !consumer_.words) return refuse_link(of, link, 4, "links are made in PreOperational");
  offer(of, link);
}

// --- states --------------------------------------------------------------------------------------------------------------

static const int8_t ways_[][7] = {{0, 3, 3, 1, 2, 3}, {3, 0, 4, 7, 8, 9, 0}, {3, 4, 1, 4}, {3, 6, 1, 6}, {3, 7, 1, 7}, {4, 0, 4, 7, 8, 9, 0},
                                  {4, 3, 2, 7, 3}, {4, 5, 1, 5}, {4, 6, 1, 6}, {4, 7, 1, 7}, {5, 4, 1, 4}, {5, 6, 1, 6},
                                  {6, 0, 4, 7, 8, 9, 0}, {6, 3, 2, 7, 3}, {6, 7, 1, 7}, {7, 0, 3, 8, 9, 0}, {7, 3, 1, 3}};

static int find_way(int target) {
  for (size_t i = 0; i < sizeof ways_ / sizeof *ways_; ++i)
    if (ways_[i][0] == state_ && ways_[i][1] == target) return (int)i;
  return -1;
}

static void arrive(int state) {
  state_ = state;
  store_checked(vital_ + 8, (uint32_t)state);
  event(0xF000, (uint8_t[]){(uint8_t)state}, 1);
  if (++way_at_ < way_size_) return;
  way_size_ = way_at_ = 0;
  if (has_way_request_) done(&way_request_, 7);
  has_way_request_ = 0;
}

static void close_lamp(void) {
  if (lamp_ < 0) return;
  char own[128];
  snprintf(own, sizeof own, "%s.subsystem", address_);
  close(lamp_);
  unlink(own);
  lamp_ = -1;
}

static void release(void) {
  if (!configured_) return;
  if (consumer_.words) store32(vital_ + 96, 0), let_go(&consumer_, 2);
  for (int i = 0; i < max_links; ++i)
    if (producers_[i].words) let_go(&producers_[i], 1);
  for (int i = 0; i < calls_size_; ++i) fail(&calls_[i].from, 4, 0x0204, NULL, 0);
  calls_size_ = 0;
  if (write_waits_) brightness_ = wanted_brightness_, write_waits_ = 0;
  close_lamp();
  store_checked(vital_ + 28, 0);
  configured_ = 0;
  store_checked(vital_ + 12, 0);
  store32(vital_ + 16, 0);
}

static void advance(void) {
  while (way_size_ > 0) {
    int state = way_[way_at_];
    if (configured_ && state >= 3 && state <= 6) return;  // at a cycle boundary
    store_checked(vital_ + 8, (uint32_t)state);
    if (state == 1) brightness_ = first_brightness_, glow_ = 0, seen_ = 0;
    if (state == 7) release();
    arrive(state);
  }
}

static void go(int target, const request* of) {
  int place = find_way(target);
  if (place < 0) return;
  way_size_ = ways_[place][2];
  way_at_ = 0;
  for (int i = 0; i < way_size_; ++i) way_[i] = ways_[place][3 + i];
  has_way_request_ = of != NULL;
  if (of) way_request_ = *of;
  advance();
}

static void set_state(const request* of, int target) {
  int overrides = way_size_ > 0 && target == 6 && state_ >= 3 && state_ <= 6 && way_[way_at_] >= 3 && way_[way_at_] < 6;
  if (way_size_ > 0 && !overrides) return fail(of, 4, 0x0108, NULL, 0);
  if (find_way(target) < 0 || (target == 6 && !configured_) || (state_ == 3 && target == 4 && !configured_)) return fail_state(of, 4);
  if (state_ == 3 && target == 4 && !consumer_.words) return fail(of, 4, 14, NULL, 0);
  if (target == 5 && !permitted(permit_, &epoch_now_)) return fail(of, 4, 0x0107, (uint8_t[]){0}, 1);
  if (overrides && has_way_request_) fail(&way_request_, 8, 0x0204, NULL, 0);
  done(of, 3);
  go(target, of);
}

static int open_lamp(void) {
  struct sockaddr_un own = {.sun_family = AF_UNIX};
  lamp_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  snprintf(own.sun_path, sizeof own.sun_path, "%.90s.subsystem", address_);
  int probe = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (connect(probe, (struct sockaddr*)&own, sizeof own) != 0 && errno == ECONNREFUSED) unlink(own.sun_path);
  close(probe);
  if (bind(lamp_, (struct sockaddr*)&own, sizeof own) == 0) return 0;
  close(lamp_);
  lamp_ = -1;
  return errno;
}

static void configure(const request* of, uint8_t id) {
  if (way_size_ > 0) return fail(of, 4, 0x0108, NULL, 0);
  if (state_ != 3) return fail_state(of, 4);
  if (id != 1) return fail_at(of, 0x0101, 0, id);
  done(of, 3);
  if (!configured_) {
    int error = open_lamp();
    if (error) {
      uint8_t why[80] = {id, 10, 0, 0, 0, 0, 0, 0, 0, (uint8_t)error, 'l', 'a', 'm', 'p'};
      event(0xF002, why, 74);
      why[0] = 0xFF;
      return fail(of, 8, 0x0202, why, 14);
    }
    configured_ = 1;
    structure_.on = 1, structure_.once_more = 0, structure_.interval = 20, structure_.phase = 0;
    inhibited_ = silent_ = quiet_ = damaged_ = wrong_ = repeated_ = other_ = 0;
    heard_ = lamp_alive_ = told_lost_ = fresh_ = was_stale_ = 0;
    heartbeat_ = load64(permit_ + 32);
    store_checked(vital_ + 12, id);
    store64(vital_ + 32, period_ns);
    store64(vital_ + 56, 0);
    store_checked(vital_ + 28, 1);
    next_ns_ = now_ns() + period_ns;
  }
  done(of, 7);
}
