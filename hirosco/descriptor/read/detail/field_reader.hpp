// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// What a field says besides name, type, count and unit.
enum class Says { Nothing, Told, Range, WordsAndRange, Argument, Report, Lent };

/// Reads what has a name and a type, wherever it stands; remembers which enumerations give their values names.
class FieldReader {
 public:
  FieldReader(Problems& problems, SubsystemDescriptor& subsystem) : problems_{problems}, subsystem_{subsystem} {}
  [[nodiscard]] Field read(Attributes& attributes, Says says, NameKind kind = NameKind::Plain);
  /// An element that is a field and nothing else.
  void read_plain(const xml::Element& element, std::vector<Field>& fields, Unique& names, Says says = Says::Nothing,
                  NameKind kind = NameKind::Plain);
  /// Once all is read.
  void check_enumerations();

 private:
  void read_words(Attributes& attributes, Field& field);
  void check_field_range(Attributes& attributes, Field& field);
  /// An argument knows the names of its values.
  void name_values(std::vector<Function::Argument>& arguments);

  struct EnumerationUse {
    const xml::Attribute* at;
    std::string name;
    Type type;
  };

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  std::vector<EnumerationUse> enumeration_uses_;
};

/// An enumeration of this <Subsystem> that no `enumeration` in it names would be words that nobody is ever told.
void check_enumerations_named(const xml::Element& root, Problems& problems);

/// A number that comes from outside has a range.
void expect_range(const xml::Element& element, Problems& problems, std::string_view what);

}  // namespace hirosco::descriptor::detail
