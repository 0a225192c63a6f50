#include "material/wavefront_mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "material/mtl_statements.h"
#include "table/file_error.h"
#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"
#include "table/input_file.h"

namespace gonio::material {
namespace {

constexpr double largest_exponent = 1e6;  // as brdf/phong.h bounds it

// What is passed over ------------------------------------------------------------------------

/// A statement that no reflectance can be made of; silent where all its numbers are `neutral`.
struct PassedOver {
  std::string_view keyword;
  std::string_view meaning;
  std::optional<double> neutral;
};

constexpr std::array<PassedOver, 19> passed_over{{
    {"ka", "Ka (ambient light)", 0},
    {"ke", "Ke (emitted light)", 0},
    {"ni", "Ni (refractive index)", 1},
    {"d", "d (transparency)", 1},
    {"tr", "Tr (transparency)", 0},
    {"tf", "Tf (transparency)", 1},
    {"sharpness", "sharpness (of reflections)", std::nullopt},
    {"bump", "bump (relief map)", std::nullopt},
    {"norm", "norm (normal map)", std::nullopt},
    {"disp", "disp (displacement map)", std::nullopt},
    {"decal", "decal (texture)", std::nullopt},
    {"refl", "refl (reflection map)", std::nullopt},
    {"pr", "Pr (roughness of another model)", std::nullopt},
    {"pm", "Pm (metallic part of another model)", 0},
    {"ps", "Ps (sheen)", 0},
    {"pc", "Pc (clear coat)", 0},
    {"pcr", "Pcr (clear coat)", std::nullopt},
    {"aniso", "aniso (anisotropy of another model)", 0},
    {"anisor", "anisor (anisotropy of another model)", std::nullopt},
}};

bool is_neutral(const MtlStatement& statement, double neutral) {
  for (const std::string_view word : mtl_words(statement.arguments)) {
    double value = 0;
    const char* at = word.data();
    const bool is_number =
        table::read_number(at, at + word.size(), value) == table::NumberText::number;
    if (!is_number || at != word.data() + word.size() || value != neutral) return false;
  }
  return true;
}

// A material ---------------------------------------------------------------------------------

/// The statements of one material, to be understood when all of them are there.
class Definition {
 public:
  Definition(std::string name, int line) : name_(std::move(name)), line_(line) {}

  void add(const MtlStatement& statement);
  void add_note(std::string note) { notes_.push_back(std::move(note)); }
  /// Throws MtlProblem.
  MtlMaterial understood(const std::optional<double>& default_exponent) const;
  MtlMaterial unusable(std::string problem) const;
  const std::string& name() const { return name_; }
  int line() const { return line_; }

 private:
  struct Known {
    std::string_view keyword;
    MtlStatement statement{};
    std::size_t count = 0;
  };
  enum Which : std::size_t { kd, ks, ns, illum };

  void pass_over(const MtlStatement& statement);
  std::array<double, 3> color(Which which, std::vector<std::string>& notes) const;
  bool has_highlight(std::vector<std::string>& notes) const;
  void set_highlight(MtlMaterial& material, const std::optional<double>& default_exponent) const;

  std::string name_;
  int line_;
  std::array<Known, 4> known_{{{"Kd"}, {"Ks"}, {"Ns"}, {"illum"}}};
  std::map<std::string, int> passed_;  // meaning, line of the first
  std::vector<std::string> notes_;
  bool has_diffuse_map_ = false;
};

void Definition::add(const MtlStatement& statement) {
  for (Known& known : known_) {
    if (statement.keyword != mtl_lower(known.keyword)) continue;
    known.statement = statement;
    ++known.count;
    return;
  }
  pass_over(statement);
}

void Definition::pass_over(const MtlStatement& statement) {
  has_diffuse_map_ = has_diffuse_map_ || statement.keyword == "map_kd";
  // Garbage may hold any number of them.
  constexpr std::size_t most = 30;
  if (passed_.size() >= most) return;
  const auto* const entry =
      std::find_if(passed_over.begin(), passed_over.end(),
                   [&](const PassedOver& p) { return p.keyword == statement.keyword; });
  if (entry != passed_over.end()) {
    if (entry->neutral && is_neutral(statement, *entry->neutral)) return;
    passed_.emplace(entry->meaning, statement.line);
  } else if (statement.keyword.starts_with("map_")) {
    passed_.emplace(table::quoted(statement.keyword) + " (texture)", statement.line);
  } else {
    passed_.emplace(table::quoted(statement.keyword) + " (not understood)", statement.line);
  }
}

std::array<double, 3> Definition::color(Which which, std::vector<std::string>& notes) const {
  const Known& known = known_[which];
  if (known.count == 0) {
    notes.emplace_back(which == kd ? "no Kd: the diffuse part is black" : "no Ks: no highlight");
    return {};
  }
  const std::array<double, 3> color = mtl_color(known.statement, known.keyword);
  if (*std::max_element(color.begin(), color.end()) > 1) {
    notes.push_back(fmt::format("line {}: {} is above 1: more is reflected than arrives",
                                known.statement.line, known.keyword));
  }
  return color;
}

bool Definition::has_highlight(std::vector<std::string>& notes) const {
  if (known_[illum].count == 0) return true;
  const MtlStatement& statement = known_[illum].statement;
  const double value = mtl_number(statement, "illum");
  if (!(value >= 0 && value <= 10) || value != static_cast<int>(value)) {
    throw MtlProblem(statement.line,
                     fmt::format("found illumination model {}, expected a whole number from 0 "
                                 "to 10 after illum (2: diffuse with highlight)",
                                 value));
  }
  if (value == 0) {
    notes.emplace_back(known_[ks].count > 0
                           ? "illum 0: a constant colour, taken for a diffuse one; Ks is unused"
                           : "illum 0: a constant colour, taken for a diffuse one");
  }
  if (value == 1 && known_[ks].count > 0) notes.emplace_back("illum 1: no highlight, Ks is unused");
  if (value > 2) {
    notes.push_back(
        fmt::format("illum {}: only its diffuse part and its highlight are taken, not "
                    "reflection, refraction or shadow",
                    value));
  }
  return value > 1;
}

void Definition::set_highlight(MtlMaterial& material,
                               const std::optional<double>& default_exponent) const {
  material.specular = color(ks, material.notes);
  std::optional<double> exponent;
  if (known_[ns].count > 0) exponent = mtl_number(known_[ns].statement, "Ns");
  if (material.specular == std::array<double, 3>{}) return;
  if (!exponent && !default_exponent) {
    throw MtlProblem(line_,
                     "has Ks but no Ns, the highlight's exponent; add Ns, or give the option "
                     "--default-exponent N");
  }
  if (!exponent) {
    material.notes.push_back(
        fmt::format("no Ns: the exponent is the default {}", *default_exponent));
  }
  material.exponent = exponent.value_or(default_exponent.value_or(0));
  if (!(material.exponent > 0 && material.exponent <= largest_exponent)) {
    throw MtlProblem(known_[ns].statement.line,
                     fmt::format("found exponent {} after Ns, expected one above 0 and up to "
                                 "{}; without a highlight, Ks is to be 0",
                                 material.exponent, largest_exponent));
  }
}

MtlMaterial Definition::understood(const std::optional<double>& default_exponent) const {
  MtlMaterial material;
  material.name = name_;
  material.line = line_;
  material.notes = notes_;
  if (name_.empty()) throw MtlProblem(line_, "found newmtl without a name; add one");
  if (known_[kd].count == 0 && known_[ks].count == 0) {
    throw MtlProblem(line_, "has neither Kd nor Ks; add 'Kd RED GREEN BLUE'");
  }
  if (known_[kd].count == 0 && has_diffuse_map_) {
    throw MtlProblem(line_,
                     "has no Kd but a texture, map_Kd; add the texture's mean colour as "
                     "'Kd RED GREEN BLUE'");
  }
  for (const Known& known : known_) {
    if (known.count < 2) continue;
    material.notes.push_back(fmt::format("{} stands {} times: the last, in line {}, counts",
                                         known.keyword, known.count, known.statement.line));
  }
  material.diffuse = color(kd, material.notes);
  if (has_highlight(material.notes)) set_highlight(material, default_exponent);
  for (const auto& [meaning, line] : passed_) {
    material.notes.push_back(fmt::format("line {}: passed over: {}", line, meaning));
  }
  return material;
}

MtlMaterial Definition::unusable(std::string problem) const {
  MtlMaterial material;
  material.name = name_;
  material.line = line_;
  material.problem = std::move(problem);
  return material;
}

// The file -----------------------------------------------------------------------------------

/// The materials read so far, and the definition whose statements are being gathered.
class Library {
 public:
  Library(const std::string& path, const std::optional<double>& default_exponent)
      : path_(path), default_exponent_(default_exponent) {}

  void add(const MtlStatement& statement);
  /// Ends the last definition.
  std::vector<MtlMaterial> finished();

 private:
  void finish_definition();
  MtlMaterial understood(const Definition& definition);

  std::string path_;
  std::optional<double> default_exponent_;
  std::optional<Definition> open_;
  std::vector<MtlMaterial> materials_;
  std::unordered_map<std::string, int> first_lines_;  // of each name
  std::string stray_;
};

void Library::add(const MtlStatement& statement) {
  if (statement.keyword == "newmtl") {
    finish_definition();
    open_.emplace(statement.arguments, statement.line);
    if (!stray_.empty()) open_->add_note(std::exchange(stray_, ""));
  } else if (open_) {
    open_->add(statement);
  } else if (stray_.empty()) {
    stray_ = fmt::format("line {}: {} stands before the first newmtl, in no material: passed over",
                         statement.line, table::quoted(statement.keyword));
  }
}

MtlMaterial Library::understood(const Definition& definition) {
  try {
    MtlMaterial material = definition.understood(default_exponent_);
    const auto [first, is_new] = first_lines_.emplace(definition.name(), definition.line());
    if (!is_new) {
      throw MtlProblem(
          definition.line(),
          fmt::format("has the name of the one in line {}; rename one of them", first->second));
    }
    return material;
  } catch (const MtlProblem& problem) {
    return definition.unusable(fmt::format("{}: line {}: material {}: {}", path_, problem.line(),
                                           table::quoted(definition.name()), problem.what()));
  }
}

void Library::finish_definition() {
  if (open_) materials_.push_back(understood(*open_));
  open_.reset();
}

std::vector<MtlMaterial> Library::finished() {
  finish_definition();
  return std::move(materials_);
}

void require_exponent(const std::optional<double>& default_exponent) {
  if (!default_exponent) return;
  if (*default_exponent > 0 && *default_exponent <= largest_exponent) return;
  throw std::invalid_argument(
      fmt::format("the default exponent is {}, expected one above 0 and up to {}",
                  *default_exponent, largest_exponent));
}

}  // namespace

std::vector<MtlMaterial> read_wavefront_mtl(const std::string& path,
                                            std::optional<double> default_exponent) {
  require_exponent(default_exponent);
  const table::InputFile file(path);
  MtlStatementReader reader(table::without_byte_order_mark(file.bytes()));
  Library library(path, default_exponent);
  MtlStatement statement;
  while (reader.next(statement)) library.add(statement);
  std::vector<MtlMaterial> materials = library.finished();
  if (materials.empty()) {
    throw table::FileError(
        fmt::format("{}: found no 'newmtl NAME' in {} lines, expected a Wavefront material library "
                    "(.mtl) as UTF-8 or ASCII text; check that this is the file you meant",
                    path, reader.lines()));
  }
  return materials;
}

}  // namespace gonio::material
