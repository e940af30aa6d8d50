// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "hirosco/utilities/os/processor_set.hpp"

// What is reckoned with the numbers, whoever takes them.
namespace hirosco {

ProcessorSet ProcessorSet::of(std::span<const std::uint16_t> processors) noexcept {
  ProcessorSet set;
  for (const std::uint16_t processor : processors) set.add(processor);
  return set;
}

bool ProcessorSet::has(unsigned processor) const noexcept {
  return processor < most && (words_[processor / word_bits] >> (processor % word_bits) & 1UL) != 0;
}

void ProcessorSet::add(unsigned processor) noexcept {
  if (processor < most) words_[processor / word_bits] |= 1UL << (processor % word_bits);
}

void ProcessorSet::remove(unsigned processor) noexcept {
  if (processor < most) words_[processor / word_bits] &= ~(1UL << (processor % word_bits));
}

void ProcessorSet::add(const ProcessorSet& others) noexcept {
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= others.words_[i];
}

unsigned ProcessorSet::count() const noexcept {
  unsigned sum = 0;
  for (const unsigned long word : words_) sum += static_cast<unsigned>(std::popcount(word));
  return sum;
}

std::optional<unsigned> ProcessorSet::last() const noexcept {
  for (std::size_t i = words_.size(); i-- > 0;)
    if (words_[i] != 0)
      return static_cast<unsigned>((i + 1) * word_bits - 1 - static_cast<unsigned>(std::countl_zero(words_[i])));
  return std::nullopt;
}

std::optional<unsigned> ProcessorSet::beyond(const ProcessorSet& others) const noexcept {
  for (std::size_t i = 0; i < words_.size(); ++i)
    if (const unsigned long more = words_[i] & ~others.words_[i]; more != 0)
      return static_cast<unsigned>(i * word_bits + static_cast<unsigned>(std::countr_zero(more)));
  return std::nullopt;
}

std::string to_string(const ProcessorSet& processors) {
  std::string text;
  for (unsigned i = 0; i < ProcessorSet::most; ++i)
    if (processors.has(i)) text.append(text.empty() ? "" : ", ").append(std::to_string(i));
  return text;
}

}  // namespace hirosco
