// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/cad_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

namespace camway::scene::cad {
namespace {

/// A hostile file can nest assemblies until the stack is full.
constexpr int kDeepestAssembly = 100;

/// An assembly of a few bytes can have any number of parts.
constexpr std::size_t kMostParts = 1'000'000;

/// Names of shapes, by what they share with their copies.
struct ShapeNames {
  std::map<const TopoDS_TShape*, std::string> products;
  std::map<const TopoDS_TShape*, std::string> items;
};

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

/// Without blanks at both ends; nothing if it says nothing.
std::string meaningful(std::string name) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!name.empty() && is_space(name.back())) name.pop_back();
  name.erase(name.begin(), std::ranges::find_if_not(name, is_space));
  return name == "NONE" ? "" : name;
}

void note_name(std::map<const TopoDS_TShape*, std::string>& names, const TopoDS_Shape& shape,
               const std::string& name) {
  std::string useful = meaningful(name);
  if (!shape.IsNull() && !useful.empty())
    names.try_emplace(shape.TShape().get(), std::move(useful));
}

ShapeNames names_of(const XSControl_Reader& reader) {
  ShapeNames names;
  const Handle(Interface_InterfaceModel) model = reader.Model();
  const Handle(Transfer_TransientProcess) process =
      reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    const auto shape = [&] { return TransferBRep::ShapeResult(process, entity); };
    if (const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(entity);
        !definition.IsNull()) {
      if (definition->Formation().IsNull() || definition->Formation()->OfProduct().IsNull())
        continue;
      note_name(names.products, shape(), text_of(definition->Formation()->OfProduct()->Name()));
    } else if (const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
               !item.IsNull()) {
      if (const std::string name = text_of(item->Name()); !meaningful(name).empty()) {
        note_name(names.items, shape(), name);
      }
    } else if (const auto iges = Handle(IGESData_IGESEntity)::DownCast(entity); !iges.IsNull()) {
      if (iges->HasName()) note_name(names.items, shape(), text_of(iges->NameValue()));
    }
  }
  return names;
}

/// Takes an assembly apart.
class PartList {
 public:
  PartList(const ShapeNames& names, std::vector<CadPart>& parts) : names_(names), parts_(parts) {}

  /// Returns the reason why it is refused, or nothing.
  std::string add(const TopoDS_Shape& shape, const std::string& product, int depth) {
    if (depth > kDeepestAssembly) return "has assemblies in assemblies without an end";
    if (parts_.size() > kMostParts) return "has more than " + std::to_string(kMostParts) + " parts";
    const std::string own = found(names_.products, shape);
    const std::string& inner = own.empty() ? product : own;
    if (shape.ShapeType() > TopAbs_COMPSOLID) {
      if (shape.ShapeType() <= TopAbs_FACE) add_part(shape, inner, found(names_.items, shape));
      return {};
    }
    TopoDS_Compound loose;  // faces and shells without a solid
    BRep_Builder().MakeCompound(loose);
    std::string item = found(names_.items, shape);
    for (TopoDS_Iterator child(shape); child.More(); child.Next()) {
      const TopAbs_ShapeEnum type = child.Value().ShapeType();
      if (type == TopAbs_SHELL || type == TopAbs_FACE) {
        BRep_Builder().Add(loose, child.Value());
        if (item.empty()) item = found(names_.items, child.Value());
      } else if (std::string fault = add(child.Value(), inner, depth + 1); !fault.empty()) {
        return fault;
      }
    }
    if (loose.NbChildren() > 0) add_part(loose, inner, item);
    return {};
  }

 private:
  static std::string found(const std::map<const TopoDS_TShape*, std::string>& names,
                           const TopoDS_Shape& shape) {
    const auto at = names.find(shape.TShape().get());
    return at == names.end() ? "" : at->second;
  }

  void add_part(const TopoDS_Shape& shape, const std::string& product, const std::string& item) {
    std::string name = product;
    if (!item.empty() && item != product) name += (name.empty() ? "" : "/") + item;
    if (name.empty()) name = "part_" + std::to_string(parts_.size() + 1);
    parts_.push_back({std::move(name), shape});
  }

  const ShapeNames& names_;
  std::vector<CadPart>& parts_;
};

struct Unit {
  std::string_view name;
  double metres;
};
/// The names that the library gives to units of length.
constexpr std::array<Unit, 14> kUnits = {{{"metre", 1.0},
                                          {"millimetre", 1e-3},
                                          {"centimetre", 1e-2},
                                          {"decimetre", 1e-1},
                                          {"kilometre", 1e3},
                                          {"micrometre", 1e-6},
                                          {"nanometre", 1e-9},
                                          {"inch", 0.0254},
                                          {"in", 0.0254},
                                          {"foot", 0.3048},
                                          {"feet", 0.3048},
                                          {"ft", 0.3048},
                                          {"mil", 2.54e-5},
                                          {"mile", 1609.344}}};

std::optional<double> metres_of(std::string name) {
  std::erase_if(name, [](char c) { return c == '\'' || c == ' '; });
  std::ranges::transform(name, name.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  const auto unit = std::ranges::find(kUnits, name, &Unit::name);
  if (unit == kUnits.end()) return std::nullopt;
  return unit->metres;
}

/// Takes the unit of the lengths. The library itself converts a file that mixes units, or has one
/// that is not known here.
void take_step_unit(STEPControl_Reader& reader, CadFile& file) {
  TColStd_SequenceOfAsciiString lengths;
  TColStd_SequenceOfAsciiString angles;
  TColStd_SequenceOfAsciiString solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  std::optional<double> unit;
  bool is_one = true;
  for (const TCollection_AsciiString& name : lengths) {
    const std::optional<double> metres = metres_of(name.ToCString());
    if (!metres || (unit && *unit != *metres)) is_one = false;
    if (metres) unit = metres;
    file.unit += (file.unit.empty() ? "" : ", ") + std::string(name.ToCString());
  }
  if (unit && is_one) {
    file.unit_m = *unit;
    return;
  }
  file.unit += file.unit.empty() ? "no unit, taken as millimetre" : ", taken as the library does";
  file.unit_m = kMillimetre_m;
}

/// Takes the parts out of a reader that has transferred `roots` roots.
base::Result<CadFile> finished(const XSControl_Reader& reader, CadFile file, int roots) {
  const TopoDS_Shape all = reader.OneShape();
  if (all.IsNull()) return base::Failure{"holds no surface that could be read"};
  file.roots_lost = static_cast<std::uint64_t>(std::max(0, roots - reader.NbShapes()));
  for (Interface_CheckIterator checks =
           reader.WS()->TransferReader()->TransientProcess()->CheckList(Standard_False);
       checks.More(); checks.Next()) {
    if (checks.Value()->HasFailed()) ++file.entities_with_errors;
  }
  const ShapeNames names = names_of(reader);
  if (std::string fault = PartList(names, file.parts).add(all, "", 0); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  if (file.parts.empty()) return base::Failure{"holds no surface: points and curves alone"};
  return file;
}

base::Result<CadFile> read_step(const std::string& name) {
  STEPControl_Reader reader;
  if (reader.ReadFile(name.c_str()) != IFSelect_RetDone) {
    return base::Failure{"is no STEP file, or damaged"};
  }
  CadFile file;
  file.format = "STEP";
  const int roots = reader.NbRootsForTransfer();
  if (roots == 0) return base::Failure{"has no product with a shape"};
  take_step_unit(reader, file);
  reader.TransferRoots();
  return finished(reader, std::move(file), roots);
}

base::Result<CadFile> read_iges(const std::string& name) {
  IGESControl_Reader reader;
  if (reader.ReadFile(name.c_str()) != IFSelect_RetDone) {
    return base::Failure{"is no IGES file, or damaged"};
  }
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (model.IsNull() || model->NbEntities() == 0) {
    return base::Failure{"is no IGES file, or damaged"};
  }
  CadFile file;
  file.format = "IGES";
  const double millimetres = model->GlobalSection().UnitValue();
  if (!(millimetres > 0.0) || !std::isfinite(millimetres)) {
    return base::Failure{"has a unit that is no length"};
  }
  file.unit_m = kMillimetre_m * millimetres;
  file.unit = text_of(model->GlobalSection().UnitName());
  const int roots = reader.NbRootsForTransfer();
  reader.TransferRoots();
  return finished(reader, std::move(file), roots);
}

}  // namespace

base::Result<CadFile> read_cad_file(const std::string& file, bool is_iges) {
  return is_iges ? read_iges(file) : read_step(file);
}

}  // namespace camway::scene::cad
