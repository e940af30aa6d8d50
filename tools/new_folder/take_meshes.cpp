// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "hirosco/xml/reader.hpp"
#include "robotics/shapes/mesh.hpp"
#include "tools/new_folder/meshes.hpp"
#include "tools/new_folder/other_values.hpp"

namespace hirosco::tools {

namespace {

namespace fs = std::filesystem;

/// What a package has in its folder, however that is called.
constexpr const char* package_file = "package.xml";
/// Of a name in the new folder.
constexpr std::size_t longest_stem = 60;

/// Letters, digits, '_', '-' and '.', as no file system and no XML minds.
[[nodiscard]] std::string plain_name(const fs::path& file) {
  std::string stem = file.stem().string(), ending = file.extension().string();
  stem.resize(std::min(stem.size(), longest_stem));
  for (std::string* text : {&stem, &ending})
    for (char& letter : *text) {
      const auto octet = static_cast<unsigned char>(letter);
      if (octet >= 0x80U || (std::isalnum(octet) == 0 && letter != '_' && letter != '-' && letter != '.')) letter = '_';
    }
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return (stem.empty() || stem.front() == '.' ? "mesh" + stem : stem) + ending;
}
[[nodiscard]] std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

class Taking {
 public:
  Taking(const fs::path& file, std::string_view text, const descriptor::FileSource& source,
         std::span<const fs::path> packages)
      : file_{file}, text_{text}, source_{source} {
    for (const fs::path& folder : packages) roots_.push_back({folder, false});
    // Of a tool's argument, which is somewhere: from there upwards.
    std::error_code failed;
    fs::path folder = fs::absolute(file, failed).lexically_normal().parent_path();
    for (;; folder = folder.parent_path()) {
      roots_.push_back({folder, true});
      if (folder == folder.parent_path()) break;
    }
  }

  TakenMeshes take() && {
    if (const auto tree = xml::read_tree(text_))
      for (const xml::Element& link : tree->children)
        if (link.name == "link")
          for (const xml::Element& part : link.children)
            if (part.name == "collision") take_all(link, part);
    taken_.urdf = with_values(text_, renamed_);
    return std::move(taken_);
  }

 private:
  struct Root {
    fs::path folder;
    bool may_be_package;
  };

  void take_all(const xml::Element& link, const xml::Element& element) {
    for (const xml::Element& child : element.children) take_all(link, child);
    const auto* named = element.name == "mesh" ? element.find("filename") : nullptr;
    if (named == nullptr) return;
    auto known = known_.find(named->value);
    if (known == known_.end()) {
      const auto* name = link.find("name");
      known = known_.emplace(named->value, take_one(*named, name != nullptr ? name->value : std::string{})).first;
    }
    if (!known->second.empty()) renamed_.push_back({named->value_at, known->second});
  }

  /// Its name in the new folder; empty: it stays where it is, which was told.
  [[nodiscard]] std::string take_one(const xml::Attribute& named, const std::string& link) {
    const auto stays = [&](const char* code, const std::string& why, std::string hint) {
      taken_.warnings.push_back(
          {file_,
           {named.value_at.line, named.value_at.column},
           code,
           fmt::format("mesh '{}' of link '{}' {}: this shape is not seen", named.value, link, why),
           std::move(hint),
           std::max<std::size_t>(1, named.value.size()),
           descriptor::Grade::Warning});
      return std::string{};
    };
    const auto kind = robotics::mesh_kind(named.value);
    if (!kind)
      return stays("U0702", "cannot be read: " + kind.error(),
                   "convert it to STL, or give the link boxes and cylinders");
    const auto places = places_of(named.value);
    if (places.empty())
      return stays("U0706", "is named in a way that nobody follows",
                   "package://A/B, file:///A/B, or a way from this file's folder");
    for (const fs::path& place : places) {
      auto octets = source_(place);
      if (!octets && octets.error().code == ErrorCode::NotFound) continue;
      if (!octets)
        return stays("U0707", fmt::format("cannot be taken along: {} {}", place.string(), octets.error().text),
                     "make it readable, and coarser where it is too large: a few thousand triangles are enough");
      if (const auto before = taken_at_.find(place); before != taken_at_.end()) return before->second;
      const auto too_much = [&] {
        return stays("U0707",
                     fmt::format("is too much: a folder takes {} of at most {} MiB in all", most_taken_meshes,
                                 most_taken_octets >> 20U),
                     "make them coarser: a few thousand triangles are enough");
      };
      if (taken_.files.size() == most_taken_meshes) return too_much();
      const auto mesh = robotics::read_mesh(*kind, *octets);
      if (!mesh) {
        taken_.warnings.push_back(
            {place, mesh.error().at, "U0704",
             fmt::format("the mesh of link '{}' is wrong: {}: it is left out, and this shape is not seen", link,
                         mesh.error().text),
             "export it anew", 1, descriptor::Grade::Warning});
        return {};
      }
      const bool as_stl = becomes_stl(*kind, *mesh, *octets, named, link);
      if (octets_ + octets->size() > most_taken_octets) return too_much();
      octets_ += octets->size();
      const std::string name = free_name(as_stl ? fs::path{place}.replace_extension(".stl") : place);
      taken_.files.emplace_back(name, std::move(*octets));
      return taken_at_.emplace(place, name).first->second;
    }
    return stays("U0706",
                 fmt::format("is nowhere: not as {}{}", places.front().string(),
                             places.size() > 1 ? fmt::format(", nor at {} other places", places.size() - 1) : ""),
                 "put it there, or name the folder that has its package: --packages FOLDER");
  }

  /// Whether `octets` are those of a binary STL of this mesh now: MuJoCo reads no COLLADA and no STL that is a text, so that the world would not have
  /// what the arm keeps from.
  [[nodiscard]] bool becomes_stl(robotics::MeshKind kind, const robotics::Mesh& mesh, std::string& octets,
                                 const xml::Attribute& named, const std::string& link) {
    using robotics::MeshKind;
    if (kind == MeshKind::Obj || (kind == MeshKind::Stl && robotics::is_binary_stl(octets))) return false;
    std::string stl = robotics::as_binary_stl(mesh);
    if (stl.size() <= xml::max_document_octets) {
      octets = std::move(stl);
      return true;
    }
    taken_.warnings.push_back({file_,
                               {named.value_at.line, named.value_at.column},
                               "U0708",
                               fmt::format("mesh '{}' of link '{}' has {} triangles, as a binary STL more than {} MiB: "
                                           "it is taken as it is, its arm sees it, its world does not",
                                           named.value, link, mesh.triangles.size(), xml::max_document_octets >> 20U),
                               "make it coarser: a few thousand triangles are enough",
                               std::max<std::size_t>(1, named.value.size()),
                               descriptor::Grade::Warning});
    return false;
  }

  /// Where it may be, the likeliest first. None: it is named in no way that is known.
  [[nodiscard]] std::vector<fs::path> places_of(std::string_view named) const {
    for (const std::string_view scheme : {"package://", "model://"})
      if (named.starts_with(scheme)) return places_in_packages(named.substr(scheme.size()));
    if (constexpr std::string_view scheme = "file://"; named.starts_with(scheme)) named.remove_prefix(scheme.size());
    if (named.empty() || named.find("://") != std::string_view::npos) return {};
    return {(file_.parent_path() / named).lexically_normal()};
  }
  [[nodiscard]] std::vector<fs::path> places_in_packages(std::string_view named) const {
    const std::size_t slash = named.find('/');
    if (slash == 0 || slash == std::string_view::npos || fs::path{named}.lexically_normal().string().starts_with(".."))
      return {};
    std::vector<fs::path> places;
    for (const Root& root : roots_) places.push_back((root.folder / named).lexically_normal());
    // A package whose folder has another name than it has, as one from an archive.
    for (const Root& root : roots_)
      if (root.may_be_package && source_(root.folder / package_file))
        places.push_back((root.folder / named.substr(slash + 1)).lexically_normal());
    return places;
  }

  [[nodiscard]] std::string free_name(const fs::path& place) {
    const fs::path plain = plain_name(place.filename());
    std::string name = plain.string();
    for (int i = 2; !names_.insert(lower(name)).second; ++i)
      name = fmt::format("{}_{}{}", plain.stem().string(), i, plain.extension().string());
    return "meshes/" + name;
  }

  const fs::path& file_;
  std::string_view text_;
  const descriptor::FileSource& source_;
  std::vector<Root> roots_;
  std::map<std::string, std::string> known_;  ///< names in the new folder by those in the file
  std::map<fs::path, std::string> taken_at_;  ///< the same by where they are
  std::set<std::string> names_;
  std::vector<OtherValue> renamed_;
  std::size_t octets_{0};
  TakenMeshes taken_;
};

}  // namespace

TakenMeshes take_meshes(const fs::path& file, std::string_view text, const descriptor::FileSource& source,
                        std::span<const fs::path> packages) {
  return Taking{file, text, source, packages}.take();
}

}  // namespace hirosco::tools
