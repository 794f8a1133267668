#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {
namespace {

/// Number of a part of the boom; its key in the file begins with the part's name.
template <typename Part>
struct PartKey {
  const char* key;
  const char* unit;
  double Part::*field;
};

template <typename Part, std::size_t N>
void readNumbers(ParameterReader& reader, const std::string& prefix, const PartKey<Part> (&keys)[N], Part& part) {
  for (const PartKey<Part>& k : keys) part.*k.field = reader.number(prefix + k.key, k.unit, NumberRule::any());
}

constexpr PartKey<CylinderParameters> kCylinderKeys[] = {
    {"base_x_m", "m", &CylinderParameters::base_x},
    {"base_z_m", "m", &CylinderParameters::base_z},
    {"rod_x_m", "m", &CylinderParameters::rod_x},
    {"rod_z_m", "m", &CylinderParameters::rod_z},
    {"bore_m", "m", &CylinderParameters::bore},
    {"rod_diameter_m", "m", &CylinderParameters::rod_diameter},
    {"closed_length_m", "m", &CylinderParameters::closed_length},
    {"stroke_m", "m", &CylinderParameters::stroke},
    {"bore_hose_volume_m3", "m3", &CylinderParameters::bore_hose_volume},
    {"rod_hose_volume_m3", "m3", &CylinderParameters::rod_hose_volume},
    {"relief_pressure_Pa", "Pa", &CylinderParameters::relief_pressure},
};

constexpr PartKey<BucketLinkageParameters> kLinkageKeys[] = {
    {"rocker_link_base_x_m", "m", &BucketLinkageParameters::guide_x},
    {"rocker_link_base_z_m", "m", &BucketLinkageParameters::guide_z},
    {"rocker_link_length_m", "m", &BucketLinkageParameters::guide_length},
    {"coupler_length_m", "m", &BucketLinkageParameters::coupler_length},
};

constexpr PartKey<CylinderParameters> kOptionalKeys[] = {
    {"friction", "", &CylinderParameters::friction},
    {"friction_std", "", &CylinderParameters::friction_std},
    {"friction_force_N", "N", &CylinderParameters::friction_force},
    {"friction_force_std_N", "N", &CylinderParameters::friction_force_std},
    {"stiffness_std", "", &CylinderParameters::stiffness_std},
    {"joint_zero_rad", "rad", &CylinderParameters::joint_zero},
    {"joint_zero_std_rad", "rad", &CylinderParameters::joint_zero_std},
    {"pressure_offset_Pa", "Pa", &CylinderParameters::pressure_offset},
    {"pressure_offset_std_Pa", "Pa", &CylinderParameters::pressure_offset_std},
};

constexpr PartKey<WeighedLink> kWeighedKeys[] = {
    {"mass_kg", "kg", &WeighedLink::mass},
    {"com_x_m", "m", &WeighedLink::com_x},
    {"com_z_m", "m", &WeighedLink::com_z},
    {"inertia_kg_m2", "kg m2", &WeighedLink::inertia},
    {"moment_x_std_kg_m", "kg m", &WeighedLink::moment_x_std},
    {"moment_z_std_kg_m", "kg m", &WeighedLink::moment_z_std},
};

constexpr PartKey<Supports> kSupportKeys[] = {
    {"support_front_x_m", "m", &Supports::front_x},
    {"support_front_half_width_m", "m", &Supports::front_half_width},
    {"support_rear_x_m", "m", &Supports::rear_x},
    {"support_rear_half_width_m", "m", &Supports::rear_half_width},
};

std::optional<BucketLinkageParameters> readLinkage(ParameterReader& reader, const std::string& name) {
  const std::string key = name + "_linkage";
  if (!reader.given(key)) return {};
  constexpr std::array<Named<bool>, 1> kKinds{{{"bucket", true}}};
  reader.choice(key, kKinds);
  BucketLinkageParameters linkage;
  readNumbers(reader, name + "_", kLinkageKeys, linkage);
  if (reader.given(key + "_branch")) linkage.branch = reader.number(key + "_branch", "", NumberRule::any());
  return linkage;
}

CylinderParameters readCylinder(ParameterReader& reader, const std::string& name) {
  CylinderParameters cylinder;
  cylinder.name = name;
  cylinder.joint = reader.text(name + "_joint");
  readNumbers(reader, name + "_", kCylinderKeys, cylinder);
  cylinder.linkage = readLinkage(reader, name);
  for (const PartKey<CylinderParameters>& key : kOptionalKeys) {
    const std::string whole = name + "_" + key.key;
    if (reader.given(whole)) cylinder.*key.field = reader.number(whole, key.unit, NumberRule::any());
  }
  return cylinder;
}

SectionParameters readSection(ParameterReader& reader, const std::string& name) {
  const std::string prefix = name + "_section_";
  const auto number = [&](const char* key, const char* unit) {
    return reader.number(prefix + key, unit, NumberRule::any());
  };
  SectionParameters section;
  section.name = name;
  section.link = reader.text(prefix + "link");
  section.origin = {number("x_m", "m"), number("y_m", "m"), number("z_m", "m")};
  section.pitch = number("pitch_rad", "rad");
  bool beyond = false;
  for (const char* key :
       {"mass_beyond_kg", "com_beyond_x_m", "com_beyond_y_m", "com_beyond_z_m", "inertia_beyond_kg_m2"})
    beyond = reader.given(prefix + key) || beyond;
  if (!beyond) return section;
  PartBeyond& part = section.beyond.emplace();
  part.mass = number("mass_beyond_kg", "kg");
  part.com = {number("com_beyond_x_m", "m"), number("com_beyond_y_m", "m"), number("com_beyond_z_m", "m")};
  part.inertia_y = number("inertia_beyond_kg_m2", "kg m2");
  return section;
}

constexpr std::array<const char*, 4> kOilKeys{"bulk_modulus_Pa", "damping_ratio", "mode_refresh_angle_rad",
                                              "rigid_tolerance"};
constexpr std::array<const char*, 7> kOtherKeys{"root_link",     "tip_link",      "cylinders",     "sections",
                                                "weighed_links", "link_mass_std", "link_com_std_m"};

/// Reads the keys of the oil, which may be omitted together for a boom without cylinders.
void readOil(ParameterReader& reader, bool cylinders, BoomParameters& p) {
  const auto given = [&](const char* key) { return reader.given(key); };
  if (std::count_if(kOilKeys.begin(), kOilKeys.end(), given) == 0 && !cylinders) return;  // given() marks them known
  p.bulk_modulus = reader.number("bulk_modulus_Pa", "Pa", NumberRule::any());
  p.vibration.damping_ratio = reader.number("damping_ratio", "", NumberRule::any());
  p.vibration.refresh_angle = reader.number("mode_refresh_angle_rad", "rad", NumberRule::any());
  p.rigid_tolerance = reader.number("rigid_tolerance", "", NumberRule::any());
}

}  // namespace

BoomParameters readBoomParameters(ParameterReader& reader) {
  BoomParameters p;
  p.chain.root = reader.text("root_link");
  p.chain.tip = reader.text("tip_link");
  for (const std::string& name : reader.names("cylinders")) p.cylinders.push_back(readCylinder(reader, name));
  readOil(reader, !p.cylinders.empty(), p);
  if (reader.given("weighed_links")) {
    for (const std::string& name : reader.names("weighed_links")) {
      WeighedLink& link = p.chain.weighed.emplace_back();
      link.name = name;
      readNumbers(reader, name + "_", kWeighedKeys, link);
    }
  }
  if (reader.given("link_mass_std")) p.link_mass_std = reader.number("link_mass_std", "", NumberRule::within(0.0, 1.0));
  if (reader.given("link_com_std_m"))
    p.link_com_std = reader.number("link_com_std_m", "m", NumberRule::within(0.0, 10.0));
  if (reader.given("sections")) {
    for (const std::string& name : reader.names("sections")) p.sections.push_back(readSection(reader, name));
  }
  const auto given = [&](const PartKey<Supports>& k) { return reader.given(k.key); };
  if (std::count_if(std::begin(kSupportKeys), std::end(kSupportKeys), given) > 0 || !p.cylinders.empty())
    readNumbers(reader, "", kSupportKeys, p.supports.emplace());
  return p;
}

bool hasBoomKey(const ParameterMap& parameters) {
  const auto given = [&](const char* key) { return parameters.count(key) != 0; };
  const auto any = [&](const auto& keys) { return std::any_of(keys.begin(), keys.end(), given); };
  return any(kOtherKeys) || any(kOilKeys) ||
         std::any_of(std::begin(kSupportKeys), std::end(kSupportKeys),
                     [&](const PartKey<Supports>& k) { return given(k.key); });
}

std::string boomYaml(const std::string& parameters) {
  std::vector<std::string> problems;
  std::optional<ParameterMap> map = parameterMap(YAML::Load(parameters), {}, problems);
  if (!map || !hasBoomKey(*map)) return {};
  ParameterReader reader(*std::move(map));
  readBoomParameters(reader);
  return reader.yaml();
}

}  // namespace hammer_loads
