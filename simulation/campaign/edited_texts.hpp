// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::campaign {

/// The descriptors of a flight's members as somebody edits them while it flies: what REREAD and REPLACE read (docs/adr/0095, 0214).
class EditedTexts {
 public:
  struct Edit {
    std::uint32_t crc{0};  ///< of the text that stands in the file now
    bool sound{true};  ///< false: nobody may fly by it
  };

  EditedTexts(const descriptor::Mission& mission, descriptor::FileSource disk)
      : mission_{mission}, disk_{std::move(disk)} {}
  EditedTexts(const EditedTexts&) = delete;
  EditedTexts& operator=(const EditedTexts&) = delete;

  /// Writes the file of a member: a number, reports more seldom by that factor; `faulty`, what is no descriptor; `forbidden`, what cannot change in
  /// flight; `back`, as it was. Empty: no such member, or no such edit.
  std::optional<Edit> edit(std::string_view member, std::string_view how);
  /// What is read in flight, changed by `reads` where it was edited, unless that is empty; it must not outlive this.
  [[nodiscard]] descriptor::FileSource source(std::function<std::string(std::string)> reads);

 private:
  const descriptor::Mission& mission_;
  descriptor::FileSource disk_;
  std::map<std::filesystem::path, std::string> edited_;
};

}  // namespace hirosco::campaign
