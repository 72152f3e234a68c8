#include "elastimate/io/abaqus/abaqus_deck.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "elastimate/io/abaqus/abaqus_elements.h"
#include "elastimate/io/text/parsed_number.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Cells = std::vector<std::string_view>;
using Members = NumberedSet::Members;

std::optional<std::size_t> ToNumber(std::string_view cell) {
  // Numbers of nodes and elements have no sign.
  return cell.substr(0, 1) == "+" ? std::nullopt
                                  : ParsedNumber<std::size_t>(cell);
}

std::size_t NumberIn(const KeywordBlock& block, const KeywordData& data,
                     std::string_view cell) {
  const std::optional<std::size_t> number = ToNumber(cell);
  if (!number) {
    block.FailAt(data.line, "'" + Printable(cell) +
                                "' is no number of a node or an element; "
                                "correct it");
  }
  return *number;
}

/// Reads a number as Fortran writes it too, "1.5D-3".
double RealIn(const KeywordBlock& block, const KeywordData& data,
              std::string_view cell) {
  std::string text(cell);
  boost::to_lower(text);
  std::replace(text.begin(), text.end(), 'd', 'e');
  const std::optional<double> value = ParsedNumber<double>(text);
  if (!text.empty() && !value) {
    block.FailAt(data.line,
                 "'" + Printable(cell) + "' is not a number; correct it");
  }
  return value.value_or(0);  // An empty cell is zero.
}

Eigen::VectorXd RealsIn(const KeywordBlock& block, const KeywordData& data,
                        std::size_t count) {
  Eigen::VectorXd values =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  const Cells cells = KeywordCells(data.text);
  for (std::size_t i = 0; i < std::min(count, cells.size()); ++i) {
    values[static_cast<Eigen::Index>(i)] = RealIn(block, data, cells[i]);
  }
  return values;
}

/// Interprets one keyword after the other.
class DeckParser {
 public:
  explicit DeckParser(AbaqusDeck& deck) : deck_(deck) {}

  void Parse(const KeywordBlock& block) {
    using Function = void (DeckParser::*)(const KeywordBlock&);
    static const std::map<std::string, Function> kFunctions = {
        {"ASSEMBLY", &DeckParser::Open},
        {"ENDASSEMBLY", &DeckParser::Close},
        {"PART", &DeckParser::OpenPart},
        {"ENDPART", &DeckParser::ClosePart},
        {"INSTANCE", &DeckParser::OpenInstance},
        {"ENDINSTANCE", &DeckParser::Close},
        {"NODE", &DeckParser::Nodes},
        {"ELEMENT", &DeckParser::Elements},
        {"NSET", &DeckParser::NodeSet},
        {"ELSET", &DeckParser::ElementSet},
        {"SURFACE", &DeckParser::Surface},
        {"TIE", &DeckParser::Tie},
        {"SOLIDSECTION", &DeckParser::Section}};
    static const std::set<std::string> kGenerators = {
        "NGEN",   "NFILL",  "NCOPY",    "NMAP",        "ELGEN",
        "ELCOPY", "SYSTEM", "SUBMODEL", "SUBSTRUCTURE"};
    if (const auto found = kFunctions.find(block.name);
        found != kFunctions.end()) {
      (this->*found->second)(block);
    } else if (kGenerators.count(block.name) > 0) {
      block.Fail("*" + block.name +
                 " is not read; import the file into Abaqus/CAE and write it "
                 "again (Job > Write Input), which lists all nodes and "
                 "elements");
    }
  }

  void CheckEnd() const {
    if (!open_.empty()) {
      open_.back()->Fail("this *" + open_.back()->name + " has no *END " +
                         open_.back()->name +
                         "; the file was cut, write it again");
    }
  }

 private:
  void Open(const KeywordBlock& block) { open_.push_back(&block); }

  void Close(const KeywordBlock& block) {
    if (open_.empty() || block.name != "END" + open_.back()->name) {
      block.Fail("*" + block.name + " ends nothing; correct the file");
    }
    open_.pop_back();
  }

  void OpenPart(const KeywordBlock& block) {
    Open(block);
    const std::string name = NameIn(block, "NAME");
    scope_ = &deck_.parts[boost::to_lower_copy(name)];
  }

  void ClosePart(const KeywordBlock& block) {
    Close(block);
    scope_ = &deck_.outside;
  }

  void OpenInstance(const KeywordBlock& block) {
    Open(block);
    AbaqusInstance instance;
    instance.name = NameIn(block, "NAME");
    instance.part = NameIn(block, "PART");
    instance.block = &block;
    if (!block.data.empty()) {
      const Eigen::Vector3d shift = RealsIn(block, block.data[0], 3);
      instance.placement = Eigen::Translation3d(shift);
    }
    if (block.data.size() > 1) {
      const Eigen::VectorXd line = RealsIn(block, block.data[1], 7);
      const Eigen::Vector3d from = line.head(3);
      const Eigen::Vector3d axis = line.segment(3, 3) - from;
      if (!(axis.norm() > 0)) {
        block.FailAt(block.data[1].line,
                     "the two points of the axis of rotation are one; correct "
                     "them");
      }
      constexpr double kRadiansPerDegree = 0.017453292519943295;
      instance.placement =
          Eigen::Translation3d(from) *
          Eigen::AngleAxisd(kRadiansPerDegree * line[6], axis.normalized()) *
          Eigen::Translation3d(-from) * instance.placement;
    }
    deck_.instances.push_back(instance);
  }

  void Nodes(const KeywordBlock& block) {
    const std::string system = block.Option("SYSTEM");
    if (!system.empty() && system != "R" && system != "r") {
      block.Fail(
          "the nodes are in cylindrical or spherical coordinates; write "
          "the file again with x, y and z (SYSTEM=R)");
    }
    AbaqusSet set = NewSet(block, "NSET", Members::kNodes);
    for (const KeywordData& data : block.data) {
      const Cells cells = KeywordCells(data.text);
      const std::size_t number =
          NumberIn(block, data, cells.empty() ? data.text : cells[0]);
      if (cells.size() < 3) {
        block.FailAt(data.line, "node " + std::to_string(number) +
                                    " has fewer than two coordinates; correct "
                                    "it");
      }
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      for (std::size_t i = 1; i < std::min<std::size_t>(cells.size(), 4); ++i) {
        position[static_cast<Eigen::Index>(i) - 1] =
            RealIn(block, data, cells[i]);
      }
      scope_->mesh.node_numbers.push_back(number);
      scope_->mesh.positions.push_back(position);
      AddNumber(number, data, set);
    }
    KeepIfNamed(std::move(set));
  }

  void Elements(const KeywordBlock& block) {
    const std::string name = boost::to_upper_copy(NameIn(block, "TYPE"));
    NumberedMesh& mesh = scope_->mesh;
    const std::size_t type = mesh.types.size();
    mesh.types.push_back(AbaqusType(name));
    const auto due = static_cast<std::size_t>(mesh.types[type].NumNodes());
    AbaqusSet set = NewSet(block, "ELSET", Members::kElements);
    for (std::size_t i = 0; i < block.data.size(); ++i) {
      const KeywordData& first = block.data[i];
      NumberedElement element = {0, type, mesh.nodes_of_elements.size(), 0};
      bool has_number = false;
      for (bool goes_on = true; goes_on;) {
        const KeywordData& data = block.data[i];
        for (const std::string_view cell : KeywordCells(data.text)) {
          if (!has_number) {
            element.number = NumberIn(block, data, cell);
            has_number = true;
          } else if (due > 0 || ToNumber(cell)) {
            mesh.nodes_of_elements.push_back(NumberIn(block, data, cell));
            ++element.num_nodes;
          }
        }
        goes_on = i + 1 < block.data.size() &&
                  (due > 0 ? element.num_nodes < due : data.text.back() == ',');
        i += goes_on ? 1 : 0;
      }
      if (due > 0 && element.num_nodes != due) {
        block.FailAt(first.line, "element " + std::to_string(element.number) +
                                     " of type " + Printable(name) + " has " +
                                     std::to_string(element.num_nodes) +
                                     " nodes where " + std::to_string(due) +
                                     " are due; correct it");
      }
      mesh.elements.push_back(element);
      AddNumber(element.number, first, set);
    }
    KeepIfNamed(std::move(set));
  }

  void NodeSet(const KeywordBlock& block) {
    AbaqusSet set = NewSet(block, "NSET", Members::kNodes);
    NameIn(block, "NSET");
    if (block.Has("ELSET")) {
      // The nodes of these elements.
      set.entries.push_back(
          {block.Option("ELSET"), 0, 0, 1, "", true, block.line});
    } else {
      AddEntries(set);
    }
    KeepIfNamed(std::move(set));
  }

  void ElementSet(const KeywordBlock& block) {
    AbaqusSet set = NewSet(block, "ELSET", Members::kElements);
    NameIn(block, "ELSET");
    AddEntries(set);
    KeepIfNamed(std::move(set));
  }

  void Surface(const KeywordBlock& block) {
    const std::string type = boost::to_upper_copy(block.Option("TYPE"));
    if (!type.empty() && type != "ELEMENT" && type != "NODE") {
      return;  // A surface of a rigid tool.
    }
    if (block.Has("COMBINE")) {
      return;  // A surface that is made of others.
    }
    const bool is_of_nodes = type == "NODE";
    AbaqusSet set =
        NewSet(block, "NAME", is_of_nodes ? Members::kNodes : Members::kFacets);
    NameIn(block, "NAME");
    for (const KeywordData& data : block.data) {
      const Cells cells = KeywordCells(data.text);
      if (cells.empty() || cells[0].empty()) {
        continue;
      }
      AbaqusEntry entry = EntryOf(cells[0], data);
      if (cells.size() > 1 && !is_of_nodes) {
        entry.face = boost::to_upper_copy(std::string(cells[1]));
      }
      set.entries.push_back(entry);
    }
    KeepIfNamed(std::move(set));
  }

  void Tie(const KeywordBlock& /*block*/) { deck_.has_ties = true; }

  void Section(const KeywordBlock& block) {
    const std::string set = block.Option("ELSET");
    if (!set.empty()) {
      scope_->mesh.material_sets.push_back(set);
    }
    if (!block.data.empty()) {
      deck_.thickness = RealsIn(block, block.data[0], 1)[0];
    }
  }

  /// Returns a set of the name in this parameter, which may be missing.
  static AbaqusSet NewSet(const KeywordBlock& block, const std::string& option,
                          Members members) {
    return {block.Option(option),  members, block.Option("INSTANCE"),
            block.Has("INTERNAL"), {},      &block};
  }

  /// Returns a parameter that has to be there.
  static std::string NameIn(const KeywordBlock& block,
                            const std::string& option) {
    std::string name = block.Option(option);
    if (name.empty()) {
      block.Fail("*" + block.name + " has no " + option + "; give " + option +
                 "=NAME");
    }
    return name;
  }

  static AbaqusEntry EntryOf(std::string_view cell, const KeywordData& data) {
    AbaqusEntry entry;
    entry.line = data.line;
    if (const std::optional<std::size_t> number = ToNumber(cell)) {
      entry.first = entry.last = *number;
    } else {
      entry.name =
          boost::trim_copy_if(std::string(cell), boost::is_any_of("\""));
    }
    return entry;
  }

  static void AddNumber(std::size_t number, const KeywordData& data,
                        AbaqusSet& set) {
    if (!set.name.empty()) {
      set.entries.push_back({"", number, number, 1, "", false, data.line});
    }
  }

  static void AddEntries(AbaqusSet& set) {
    const KeywordBlock& block = *set.block;
    for (const KeywordData& data : block.data) {
      const Cells cells = KeywordCells(data.text);
      if (!block.Has("GENERATE")) {
        for (const std::string_view cell : cells) {
          if (!cell.empty()) {
            set.entries.push_back(EntryOf(cell, data));
          }
        }
        continue;
      }
      AbaqusEntry entry;
      entry.line = data.line;
      if (cells.size() < 2) {
        block.FailAt(data.line,
                     "GENERATE needs a first and a last number; correct it");
      }
      entry.first = NumberIn(block, data, cells[0]);
      entry.last = NumberIn(block, data, cells[1]);
      if (cells.size() > 2 && !cells[2].empty()) {
        entry.step = NumberIn(block, data, cells[2]);
      }
      if (entry.step == 0 || entry.first > entry.last) {
        block.FailAt(data.line,
                     "GENERATE has a step of 0, or a last number below the "
                     "first; correct it");
      }
      set.entries.push_back(entry);
    }
  }

  void KeepIfNamed(AbaqusSet set) {
    if (!set.name.empty()) {
      scope_->sets.push_back(std::move(set));
    }
  }

  AbaqusDeck& deck_;
  AbaqusScope* scope_ = &deck_.outside;
  std::vector<const KeywordBlock*> open_;
};

}  // namespace

AbaqusDeck ParseAbaqusDeck(const KeywordFile& file) {
  AbaqusDeck deck;
  DeckParser parser(deck);
  for (const KeywordBlock& block : file.blocks) {
    parser.Parse(block);
  }
  parser.CheckEnd();
  return deck;
}

}  // namespace elastimate
