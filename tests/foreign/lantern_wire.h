// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Octets and words of lantern.c: packets, the handshake, shared memory. Written from docs/interfaces alone.
#pragma once
#include <fcntl.h>
#include <linux/futex.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

// --- words of shared memory ----------------------------------------------------------------------------------------------

static uint32_t load32(const volatile uint8_t* at) { return atomic_load_explicit((_Atomic uint32_t*)(uintptr_t)at, memory_order_acquire); }
static uint64_t load64(const volatile uint8_t* at) { return atomic_load_explicit((_Atomic uint64_t*)(uintptr_t)at, memory_order_acquire); }
static void store32(volatile uint8_t* at, uint32_t value) { atomic_store_explicit((_Atomic uint32_t*)(uintptr_t)at, value, memory_order_release); }
static void store64(volatile uint8_t* at, uint64_t value) { atomic_store_explicit((_Atomic uint64_t*)(uintptr_t)at, value, memory_order_release); }
static void store_checked(volatile uint8_t* at, uint32_t value) { store32(at, (value & 0xFFFF) | (~value << 16)); }

static uint64_t permission_word(uint32_t epoch) {
  uint64_t word = epoch + 0x9E3779B97F4A7C15u;
  word = (word ^ (word >> 30)) * 0xBF58476D1CE4E5B9u;
  word = (word ^ (word >> 27)) * 0x94D049BB133111EBu;
  return word ^ (word >> 31);
}
static int permitted(const volatile uint8_t* permit, uint32_t* epoch) {
  *epoch = load32(permit + 8);
  return load64(permit + 16) == permission_word(*epoch);
}

static int64_t clock_ns(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}
static int64_t now_ns(void) { return clock_ns(CLOCK_MONOTONIC); }

// --- octets of packets, big-endian ---------------------------------------------------------------------------------------

static void put16(uint8_t* to, uint16_t value) { to[0] = (uint8_t)(value >> 8), to[1] = (uint8_t)value; }
static void put32(uint8_t* to, uint32_t value) { put16(to, (uint16_t)(value >> 16)), put16(to + 2, (uint16_t)value); }
static void put64(uint8_t* to, uint64_t value) { put32(to, (uint32_t)(value >> 32)), put32(to + 4, (uint32_t)value); }
static void put_float(uint8_t* to, float value) {
  uint32_t bits;
  memcpy(&bits, &value, 4);
  put32(to, bits);
}
static uint16_t u16(const uint8_t* at) { return (uint16_t)(at[0] << 8 | at[1]); }
static uint32_t u32(const uint8_t* at) { return (uint32_t)u16(at) << 16 | u16(at + 2); }
static float get_float(const uint8_t* at) {
  uint32_t bits = u32(at);
  float value;
  memcpy(&value, &bits, 4);
  return value;
}

static uint16_t crc16(const uint8_t* octets, size_t size) {
  uint32_t crc = 0xFFFF;
  for (size_t i = 0; i < size; ++i) {
    crc ^= (uint32_t)octets[i] << 8;
    for (int bit = 0; bit < 8; ++bit) crc = crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1;
  }
  return (uint16_t)crc;
}

/// Counts of the next report, from the counter block and written on there. The block is this program's own: no other writer.
static void stamp(volatile uint8_t* vital, uint16_t destination, uint8_t service, uint8_t subtype, uint16_t* sequence, uint16_t* count) {
  struct type {
    uint16_t destination;
    uint8_t service, subtype;
    uint16_t count, spare;
  };
  struct block {
    uint32_t used;
    uint16_t sequence, spare;
    struct type types[64];
  }* block = (struct block*)(uintptr_t)(vital + 1632);
  *sequence = block->sequence;
  *count = 0;
  block->sequence = (uint16_t)((block->sequence + 1) & 0x3FFF);
  for (uint32_t i = 0; i < block->used && i < 64; ++i) {
    struct type* each = &block->types[i];
    if (each->destination != destination || each->service != service || each->subtype != subtype) continue;
    *count = each->count++;
    return;
  }
  if (block->used < 64) block->types[block->used++] = (struct type){destination, service, subtype, 1, 0};
}

// --- the handshake -------------------------------------------------------------------------------------------------------

typedef struct {
  char name[64];
  uint8_t type;
  uint32_t count;
} field;
enum { most_fields = 32 };
typedef struct {
  int64_t period;
  int has_memory, has_latest, has_little, wakes, field_count;
  field fields[most_fields];
} terms;
typedef struct {
  uint8_t link, method, order, kind;
  uint16_t depth;
  int wakes;
  uint32_t epoch;
  int64_t producer_ns, consumer_ns;
  int field_count;
  field fields[most_fields];
  uint64_t hash;
  uint32_t payload;
} agreement;

static int octets_of_type(uint8_t type) { return type <= 2 ? 1 : type <= 4 ? 2 : type <= 6 || type == 9 ? 4 : 8; }
static int has_field(const field* of, int count, const field* wanted) {
  for (int i = 0; i < count; ++i)
    if (!strcmp(of[i].name, wanted->name) && of[i].type == wanted->type && of[i].count == wanted->count) return 1;
  return 0;
}
static size_t put_string(uint8_t* to, const char* text) {
  to[0] = (uint8_t)strlen(text);
  memcpy(to + 1, text, to[0]);
  return (size_t)to[0] + 1;
}
static size_t put_fields(uint8_t* to, const field* fields, int count) {
  size_t at = 1;
  to[0] = (uint8_t)count;
  for (int i = 0; i < count; ++i) {
    at += put_string(to + at, fields[i].name);
    to[at] = fields[i].type;
    put32(to + at + 1, fields[i].count);
    at += 5;
  }
  return at;
}

/// Reads to its end; good says at last whether all was there.
typedef struct {
  const uint8_t* data;
  size_t size, at;
  int good;
} reader;
static uint8_t get8(reader* in) {
  if (in->at + 1 > in->size) return in->good = 0, (uint8_t)0;
  return in->data[in->at++];
}
static uint16_t get16(reader* in) {
  uint16_t high = get8(in);
  return (uint16_t)(high << 8 | get8(in));
}
static uint32_t get32(reader* in) {
  uint32_t high = get16(in);
  return high << 16 | get16(in);
}
static int64_t get_period(reader* in) {
  uint64_t high = get32(in);
  int64_t value = (int64_t)(high << 32 | get32(in));
  in->good = in->good && value > 0;
  return value;
}
static void get_string(reader* in, char text[256]) {
  size_t length = get8(in);
  text[0] = 0;
  if (!in->good || length == 0 || in->at + length > in->size) {
    in->good = 0;
    return;
  }
  for (size_t i = 0; i < length; ++i) in->good = in->good && in->data[in->at + i] >= 0x20 && in->data[in->at + i] <= 0x7E;
  memcpy(text, in->data + in->at, length);
  text[length] = 0;
  in->at += length;
}
static int get_choices(reader* in, uint8_t highest, uint8_t wanted, int* queued) {
  int count = get8(in), found = 0;
  in->good = in->good && count >= 1 && count <= 16;
  for (int i = 0; i < count && in->good; ++i) {
    uint8_t each = get8(in);
    in->good = in->good && each >= 1 && each <= highest;
    found |= each == wanted;
    *queued |= highest == 3 && each == 2;
  }
  return found;
}
/// Beyond most_fields they are read and not kept: then nothing fits.
static int get_fields(reader* in, field* fields) {
  int count = get8(in), kept = 0;
  in->good = in->good && count >= 1;
  for (int i = 0; i < count && in->good; ++i) {
    char name[256];
    get_string(in, name);
    field each = {.type = get8(in), .count = get32(in)};
    in->good = in->good && each.type >= 1 && each.type <= 10 && each.count >= 1;
    memcpy(each.name, name, sizeof each.name - 1);
    for (int k = 0; k < kept; ++k) in->good = in->good && strcmp(fields[k].name, each.name);
    if (kept < most_fields) fields[kept++] = each;
  }
  return kept;
}
static uint16_t get_depth(reader* in, int queued) {
  uint16_t depth = get16(in);
  in->good = in->good && (queued ? depth >= 2 && depth <= 4096 : depth == 0);
  return depth;
}
static int get_flag(reader* in) {
  uint8_t flag = get8(in);
  in->good = in->good && flag <= 1;
  return flag;
}
static void get_offer(reader* in, terms* to) {
  char set[256];
  int queued = 0;
  get_string(in, set);
  to->period = get_period(in);
  to->has_memory = get_choices(in, 6, 1, &queued);
  to->has_little = get_choices(in, 2, 1, &queued);
  to->has_latest = get_choices(in, 3, 1, &queued);
  get_depth(in, queued);
  to->wakes = get_flag(in);
  to->field_count = get_fields(in, to->fields);
}
static void get_agreement(reader* in, agreement* to) {
  char set[256] = "";
  (void)set;
  to->method = get8(in), to->order = get8(in), to->kind = get8(in);
  in->good = in->good && to->method >= 1 && to->method <= 6 && to->order >= 1 && to->order <= 2 && to->kind >= 1 && to->kind <= 3;
  to->depth = get_depth(in, to->kind == 2);
  to->wakes = get_flag(in);
  to->producer_ns = get_period(in), to->consumer_ns = get_period(in);
  size_t begin = in->at;
  to->field_count = get_fields(in, to->fields);
  if (!in->good) return;
  to->hash = 0xCBF29CE484222325u;
  for (size_t i = begin; i < in->at; ++i) to->hash = (to->hash ^ in->data[i]) * 0x100000001B3u;
  to->hash = (to->hash ^ to->order) * 0x100000001B3u;
  to->hash = (to->hash ^ to->kind) * 0x100000001B3u;
  uint64_t payload = 0;
  for (int i = 0; i < to->field_count; ++i) payload += (uint64_t)octets_of_type(to->fields[i].type) * to->fields[i].count;
  in->good = payload <= 65536;
  to->payload = (uint32_t)payload;
}

// --- the memory of a link of the newest value ----------------------------------------------------------------------------

typedef struct {
  uint8_t link;
  uint32_t epoch;
  volatile uint8_t* words;
  size_t size;
  uint64_t sequence, count;
  agreement agreed;
} link_end;
enum { seal_shrink_grow = 6, seal_future_write = 16, seal_seal = 1, add_seals = 1033, get_seals = 1034 };

static size_t up(size_t number, size_t multiple) { return (number + multiple - 1) / multiple * multiple; }
static uint64_t status_word(uint32_t status) { return (uint64_t)~status << 32 | status; }

static const char* map_link(link_end* made, const agreement* agreed, int memory, int producer) {
  struct stat status;
  memset(made, 0, sizeof *made);
  made->link = agreed->link, made->epoch = agreed->epoch, made->agreed = *agreed;
  made->size = up(96 + up(agreed->payload, 8), 64);
  if (memory < 0) return "no memory beside the attach request";
  if (fstat(memory, &status) != 0 || (size_t)status.st_size != made->size) return "size of shared memory";
  int wanted = seal_shrink_grow | (producer ? 0 : seal_future_write), seals = fcntl(memory, get_seals);
  if (seals < 0 || (seals & wanted) != wanted) return "seals of shared memory";
  void* at = mmap(NULL, made->size, producer ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, memory, 0);
  if (at == MAP_FAILED) return "shared memory cannot be mapped";
  made->words = at;
  return NULL;
}
static void close_link(link_end* end) {
  munmap((void*)(uintptr_t)end->words, end->size);
  end->words = NULL;
}
static const char* make_producer(link_end* made, const agreement* agreed, int memory) {
  const char* why = map_link(made, agreed, memory, 1);
  if (why) return why;
  store64(made->words + 8, (uint64_t)2 << 32 | agreed->epoch);
  store64(made->words + 16, agreed->payload);
  store64(made->words + 24, agreed->hash);
  store64(made->words + 32, (uint64_t)agreed->producer_ns);
  store64(made->words + 72, status_word(0));
  store64(made->words, 0x4B4E494C52435348u);
  if (fcntl(memory, add_seals, seal_future_write) == 0 && fcntl(memory, add_seals, seal_seal) == 0) return NULL;
  close_link(made);
  return "seals of shared memory";
}
static const char* make_consumer(link_end* made, const agreement* agreed, int memory) {
  const char* why = map_link(made, agreed, memory, 0);
  if (why) return why;
  if (load64(made->words) != 0x4B4E494C52435348u) why = "link memory has no header";
  else if (load64(made->words + 8) != ((uint64_t)2 << 32 | agreed->epoch)) why = "link version or epoch";
  else if (load64(made->words + 16) != agreed->payload) why = "link payload size";
  else if (load64(made->words + 24) != agreed->hash) why = "link layout";
  if (why) close_link(made);
  return why;
}
static void write_sample(link_end* end, const uint8_t* payload, int64_t at, uint32_t status) {
  atomic_store_explicit((_Atomic uint64_t*)(uintptr_t)(end->words + 64), end->sequence + 1, memory_order_relaxed);
  store64(end->words + 72, status_word(status));
  store64(end->words + 80, ++end->count);
  store64(end->words + 88, (uint64_t)at);
  for (uint32_t i = 0; i < end->agreed.payload; i += 8) {
    uint64_t word = 0;
    memcpy(&word, payload + i, end->agreed.payload - i < 8 ? end->agreed.payload - i : 8);
    store64(end->words + 96 + i, word);
  }
  store64(end->words + 64, end->sequence += 2);
  // The low half of the sequence, as the page says; this computer has it first.
  if (end->agreed.wakes) syscall(SYS_futex, end->words + 64, FUTEX_WAKE, 0x7FFFFFFF, NULL, NULL, 0);
}
static void tell_status(link_end* end, uint32_t status) {
  atomic_store_explicit((_Atomic uint64_t*)(uintptr_t)(end->words + 64), end->sequence + 1, memory_order_relaxed);
  store64(end->words + 72, status_word(status));
  store64(end->words + 64, end->sequence += 2);
}
/// Copies the newest sample where there is one since the last. 0 none, 1 one; its status (4 where the word is none), count and stamp.
static int read_sample(link_end* end, uint8_t* payload, uint32_t* status, uint64_t* count, int64_t* at) {
  for (int attempt = 0; attempt < 8; ++attempt) {
    uint64_t sequence = load64(end->words + 64);
    if (sequence == end->sequence) return 0;
    if (sequence % 2) continue;
    uint64_t word = load64(end->words + 72);
    *count = load64(end->words + 80), *at = (int64_t)load64(end->words + 88);
    for (uint32_t i = 0; i < end->agreed.payload; i += 8) {
      uint64_t each = load64(end->words + 96 + i);
      memcpy(payload + i, &each, end->agreed.payload - i < 8 ? end->agreed.payload - i : 8);
    }
    if (load64(end->words + 64) != sequence) continue;
    end->sequence = sequence;
    *status = word == status_word(1) ? 1 : word == status_word(2) ? 2 : word == status_word(3) ? 3 : 4;
    int is_new = *count != end->count;
    return is_new;
  }
  return 0;
}
