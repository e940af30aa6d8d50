// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/layout_difference.hpp"

namespace hirosco {

std::string layout_difference(std::span<const NativeField> native, const std::vector<descriptor::Field>& declared) {
  if (native.size() != declared.size())
    return "the C++ type has " + std::to_string(native.size()) + " members, the descriptor declares " +
           std::to_string(declared.size()) + " fields";
  std::string differences;
  for (std::size_t i = 0; i < native.size(); ++i) {
    if (native[i].takes(declared[i].type, declared[i].count)) continue;
    const std::string held =
        native[i].most != 0 ? "at most " + std::to_string(native[i].most) : std::to_string(native[i].count);
    if (!differences.empty()) differences += "; ";
    differences += "field " + declared[i].name + ": C++ has " + std::string{to_text(native[i].type)} + "[" + held +
                   "], the descriptor declares " + std::string{to_text(declared[i].type)} + "[" +
                   std::to_string(declared[i].count) + "]";
  }
  return differences;
}

std::vector<LayoutField> agreed_layout(ObjectFields& fields, const std::vector<descriptor::Field>& declared,
                                       MutableOctets object) {
  for (std::size_t i = 0; i < declared.size(); ++i) fields.set_length(i, declared[i].count, object);
  std::vector<LayoutField> layout;
  for (const NativeField& field : fields.all()) layout.push_back({field.type, field.count, field.offset});
  return layout;
}

}  // namespace hirosco
