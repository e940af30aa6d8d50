// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hirosco/parameter/sized.hpp"
#include "hirosco/parameter/text.hpp"
#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"

/// Derives the layout of a parameter from its C++ type: no macro, no registration. A parameter may be a number, an
/// enumeration, a bool, a std::array or Sized of those, a Text, or an aggregate of up to 16 such members, of aggregates and of
/// std::arrays of these (adr 0103). Members carry no `alignas`.
namespace hirosco {

/// One value or array as it lies in memory.
struct NativeField {
  Type type{};
  std::uint32_t count{1};  ///< of a Text: its octets
  std::size_t offset{0};
  std::uint16_t most{0};  ///< of a Sized: its N, and `count` is the descriptor's, 0 until that is known
  std::size_t length_offset{0};  ///< of a Sized: where its length lies
  [[nodiscard]] constexpr std::size_t octets() const noexcept { return octets_of(type) * count; }
  /// Whether `declared` elements of a type are what this field holds, or can hold.
  [[nodiscard]] constexpr bool takes(Type wanted, std::uint32_t declared) const noexcept {
    return type == wanted && (most == 0 ? declared == count : declared >= 1 && declared <= most);
  }
  friend constexpr bool operator==(const NativeField&, const NativeField&) = default;
};

namespace layout_detail {

template <class T>
struct ArrayOf : std::false_type {
  using Element = T;
  static constexpr std::size_t count = 1;
};
template <class T, std::size_t N>
struct ArrayOf<std::array<T, N>> : std::true_type {
  using Element = T;
  static constexpr std::size_t count = N;
};
template <class T, std::size_t N>
struct ArrayOf<Sized<T, N>> : std::true_type {
  using Element = T;
  static constexpr std::size_t count = 0;
  static constexpr std::uint16_t most = N;
};

template <class T>
struct NumberOf {
  using type = T;
};
template <class T>
  requires std::is_enum_v<T>
struct NumberOf<T> {
  using type = std::underlying_type_t<T>;
};

template <class T>
concept Character = std::same_as<T, char> || std::same_as<T, wchar_t> || std::same_as<T, char8_t> ||
                    std::same_as<T, char16_t> || std::same_as<T, char32_t>;
template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool> && !Character<T> && sizeof(T) <= 8;

/// Numbers and enumerations of a definite size; bool and character types have none.
template <class T>
concept Scalar = Number<typename NumberOf<std::remove_cv_t<T>>::type>;
template <class T>
concept FieldType = Scalar<typename ArrayOf<std::remove_cv_t<T>>::Element>;

template <class T>
struct TextOf : std::false_type {};
template <std::size_t N>
struct TextOf<Text<N>> : std::true_type {
  static constexpr std::uint32_t octets = N;
};
/// What a parameter or member may be.
template <class T>
concept MemberType = FieldType<T> || std::same_as<typename ArrayOf<std::remove_cv_t<T>>::Element, bool> ||
                     TextOf<std::remove_cv_t<T>>::value;

template <Scalar S>
[[nodiscard]] constexpr Type type_of() {
  using T = typename NumberOf<std::remove_cv_t<S>>::type;
  static_assert(alignof(T) == sizeof(T), "snapshots rely on it: no number spans two words");
  if (std::is_floating_point_v<T>) return sizeof(T) == 4 ? Type::Float : Type::Double;
  switch (sizeof(T)) {
    case 1: return std::is_signed_v<T> ? Type::Int8 : Type::Uint8;
    case 2: return std::is_signed_v<T> ? Type::Int16 : Type::Uint16;
    case 4: return std::is_signed_v<T> ? Type::Int32 : Type::Uint32;
    default: return std::is_signed_v<T> ? Type::Int64 : Type::Uint64;
  }
}

struct Anything {
  template <class T>
  operator T() const;  // never defined: only its type is used
};
template <std::size_t>
using AnythingAt = Anything;

template <class T, std::size_t... I>
[[nodiscard]] consteval bool takes(std::index_sequence<I...>) {
  return requires { T{AnythingAt<I>{}...}; };
}

inline constexpr std::size_t max_members = 16;

/// Number of members of an aggregate, max_members + 1 for any larger number.
template <class T, std::size_t N = max_members + 1>
[[nodiscard]] consteval std::size_t member_count() {
  if constexpr (N == 0) return 0;
  else if constexpr (takes<T>(std::make_index_sequence<N>{})) return N;
  else return member_count<T, N - 1>();
}

template <class... Members>
struct Types {};

/// The member types of an aggregate, by structured bindings. Only its return type is used.
template <class T>
auto members_of(T& t) {
  constexpr std::size_t n = member_count<T>();
  if constexpr (n == 1) {
    [[maybe_unused]] auto& [a] = t;
    return Types<decltype(a)>{};
  } else if constexpr (n == 2) {
    [[maybe_unused]] auto& [a, b] = t;
    return Types<decltype(a), decltype(b)>{};
  } else if constexpr (n == 3) {
    [[maybe_unused]] auto& [a, b, c] = t;
    return Types<decltype(a), decltype(b), decltype(c)>{};
  } else if constexpr (n == 4) {
    [[maybe_unused]] auto& [a, b, c, d] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d)>{};
  } else if constexpr (n == 5) {
    [[maybe_unused]] auto& [a, b, c, d, e] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e)>{};
  } else if constexpr (n == 6) {
    [[maybe_unused]] auto& [a, b, c, d, e, f] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f)>{};
  } else if constexpr (n == 7) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g)>{};
  } else if constexpr (n == 8) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g),
                 decltype(h)>{};
  } else if constexpr (n == 9) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i)>{};
  } else if constexpr (n == 10) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j)>{};
  } else if constexpr (n == 11) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k)>{};
  } else if constexpr (n == 12) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k, l] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k), decltype(l)>{};
  } else if constexpr (n == 13) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k), decltype(l), decltype(m)>{};
  } else if constexpr (n == 14) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k), decltype(l), decltype(m), decltype(o)>{};
  } else if constexpr (n == 15) {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k), decltype(l), decltype(m), decltype(o), decltype(p)>{};
  } else {
    [[maybe_unused]] auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = t;
    return Types<decltype(a), decltype(b), decltype(c), decltype(d), decltype(e), decltype(f), decltype(g), decltype(h),
                 decltype(i), decltype(j), decltype(k), decltype(l), decltype(m), decltype(o), decltype(p),
                 decltype(q)>{};
  }
}

template <class Element>
[[nodiscard]] constexpr Type element_type() {
  static_assert(sizeof(bool) == 1, "a bool is one octet in memory as on the wire");
  if constexpr (std::same_as<std::remove_cv_t<Element>, bool>) return Type::Bool;
  else return type_of<Element>();
}

template <MemberType F>
[[nodiscard]] constexpr NativeField field_at(std::size_t offset) {
  using Traits = ArrayOf<std::remove_cv_t<F>>;
  if constexpr (TextOf<std::remove_cv_t<F>>::value) {
    static_assert(sizeof(F) == TextOf<std::remove_cv_t<F>>::octets, "a text is its octets and nothing else");
    return {Type::Text, TextOf<std::remove_cv_t<F>>::octets, offset};
  } else if constexpr (requires { Traits::most; }) {
    return {element_type<typename Traits::Element>(), 0, offset, Traits::most, offset + F::length_offset()};
  } else {
    static_assert(Traits::count >= 1 && Traits::count <= 16U << 20, "an array has 1 to 16 Mi elements");
    return {element_type<typename Traits::Element>(), static_cast<std::uint32_t>(Traits::count), offset};
  }
}

[[nodiscard]] constexpr std::size_t round_up(std::size_t offset, std::size_t alignment) noexcept {
  return (offset + alignment - 1) / alignment * alignment;
}

/// An aggregate with members of its own; what an array is, is not.
template <class T>
concept StructureType = std::is_class_v<T> && std::is_aggregate_v<T> && !ArrayOf<T>::value;

template <StructureType T>
[[nodiscard]] consteval auto member_types() {
  constexpr std::size_t count = member_count<T>();
  static_assert(count >= 1, "a structure has at least one member");
  static_assert(count <= max_members, "a structure has at most 16 members");
  return decltype(members_of(std::declval<T&>())){};
}

/// Most values and arrays that a parameter has, those of structures within among them.
inline constexpr std::size_t max_fields = 256;

/// Values and arrays in an object of this type: its leaves.
template <class T>
[[nodiscard]] consteval std::size_t leaf_count() {
  using Plain = std::remove_cv_t<T>;
  using Element = typename ArrayOf<Plain>::Element;
  if constexpr (MemberType<Plain>) {
    return 1;
  } else if constexpr (ArrayOf<Plain>::value && StructureType<Element>) {
    static_assert(!requires { ArrayOf<Plain>::most; }, "an array of structures has the length of its type");
    return ArrayOf<Plain>::count * leaf_count<Element>();
  } else {
    static_assert(
        StructureType<Plain>,
        "a member is a number, an enumeration, a bool, a std::array or Sized of those, a Text, a structure or a "
        "std::array of structures; characters have no definite size");
    return []<class... Members>(Types<Members...>) { return (leaf_count<Members>() + ...); }(member_types<Plain>());
  }
}

/// The leaves of an object that lies at `offset`, from `index` on.
template <class T>
constexpr void add_leaves(std::span<NativeField> leaves, std::size_t& index, std::size_t offset) {
  using Plain = std::remove_cv_t<T>;
  if constexpr (MemberType<Plain>) {
    leaves[index++] = field_at<Plain>(offset);
  } else if constexpr (ArrayOf<Plain>::value) {
    using Element = typename ArrayOf<Plain>::Element;
    for (std::size_t i = 0; i < ArrayOf<Plain>::count; ++i)
      add_leaves<Element>(leaves, index, offset + i * sizeof(Element));
  } else {
    std::size_t end = 0;
    const auto add = [&]<class M>(std::type_identity<M>) {
      end = round_up(end, alignof(M));
      add_leaves<M>(leaves, index, offset + end);
      end += sizeof(M);
    };
    [&]<class... Members>(Types<Members...>) { (add(std::type_identity<Members>{}), ...); }(member_types<Plain>());
  }
}

/// Whether the members lie where this file takes them to be: each aligned, the whole filled up.
template <class T>
[[nodiscard]] consteval bool lies_plainly() {
  using Plain = std::remove_cv_t<T>;
  if constexpr (MemberType<Plain>) {
    return true;
  } else if constexpr (ArrayOf<Plain>::value) {
    return lies_plainly<typename ArrayOf<Plain>::Element>();
  } else {
    return []<class... Members>(Types<Members...>) {
      std::size_t end = 0;
      std::size_t alignment = 1;
      ((end = round_up(end, alignof(Members)) + sizeof(Members),
        alignment = alignof(Members) > alignment ? alignof(Members) : alignment),
       ...);
      return round_up(end, alignment) == sizeof(Plain) && (lies_plainly<Members>() && ...);
    }(member_types<Plain>());
  }
}

}  // namespace layout_detail

template <class T>
concept ParameterStructure = layout_detail::StructureType<T> && !layout_detail::MemberType<T>;

/// Fields of a parameter type in order, as std::array<NativeField, N>; those of a structure within where it stands. A type that
/// has no layout does not compile.
template <class T>
[[nodiscard]] consteval auto layout_of() {
  static_assert(std::is_trivially_copyable_v<T>, "a parameter is copied octet by octet");
  static_assert(
      ParameterStructure<T> || layout_detail::MemberType<T>,
      "a parameter is a number, an enumeration, a bool, a std::array or Sized of those, a Text, or an aggregate "
      "of those; characters have no definite size");
  constexpr std::size_t count = layout_detail::leaf_count<T>();
  static_assert(count <= layout_detail::max_fields, "a parameter has at most 256 values and arrays");
  static_assert(layout_detail::lies_plainly<T>(), "members of a parameter structure carry no alignas or bit width");
  std::array<NativeField, count> fields{};
  std::size_t index = 0;
  layout_detail::add_leaves<T>(fields, index, 0);
  return fields;
}

/// A type that layout_of accepts as a single value or array.
template <class T>
concept ParameterValue = layout_detail::MemberType<T>;

/// The fields of one object: its type's, or its own where it has Sized members, whose lengths come with the descriptor.
class ObjectFields {
 public:
  ObjectFields(std::span<const NativeField> fields, std::span<NativeField> own) noexcept
      : fields_{own.empty() ? fields : own}, own_{own} {}
  [[nodiscard]] std::span<const NativeField> all() const noexcept { return fields_; }
  /// Gives a Sized field the length that its descriptor declares and fits the object to it; false for any other field.
  bool set_length(std::size_t field, std::uint32_t count, MutableOctets object) noexcept;
  /// Gives the Sized members of an object that was stored into their lengths back.  Realtime: bounded.
  void fit(MutableOctets object) const noexcept;

 private:
  std::span<const NativeField> fields_;
  std::span<NativeField> own_;
};

/// Base of what holds an object of type T, before the base that is given `fields()`; `which` of several.
template <class T, int which = 0>
class HasFields {
  static constexpr auto of_type = layout_of<T>();

 protected:
  static constexpr bool sized = [] {
    for (const NativeField& field : of_type)
      if (field.most != 0) return true;
    return false;
  }();
  [[nodiscard]] ObjectFields fields() noexcept {
    if constexpr (sized) return {of_type, own_};
    else return {of_type, {}};
  }

 private:
  struct Nothing {};
  using Own = std::conditional_t<sized, std::remove_const_t<decltype(of_type)>, Nothing>;
  [[nodiscard]] static constexpr Own own_fields() noexcept {
    if constexpr (sized) return of_type;
    else return {};
  }
  [[no_unique_address]] Own own_{own_fields()};
};

/// The C++ spelling of a field, for messages: `std::array<double, 2>`, `Sized<double, 7>`, `Text<20>`.
[[nodiscard]] std::string cpp_text(const NativeField& field);
/// The descriptor's spelling: `DOUBLE[2]`, `TEXT of 20 octets`; `count` of a text is its octets.
[[nodiscard]] std::string descriptor_text(Type type, std::uint32_t count);

}  // namespace hirosco
