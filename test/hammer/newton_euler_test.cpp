// Reference of the loads compared with tables from another source.
#include "support/newton_euler.h"

#include <gtest/gtest.h>

#include "support/csv.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::Real;

class NewtonEulerTest : public testing::TestWithParam<std::pair<const char*, Level>> {};

TEST_P(NewtonEulerTest, EqualsTheTables) {
  const test::Csv csv = test::dataCsv(GetParam().first);
  const test::NewtonEuler exact(test::mo100LinkageParameters(), GetParam().second);
  ASSERT_GT(csv.size(), 100u);
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const double g = csv.number(i, "gravity_m_s2"), pitch = csv.number(i, "hull_pitch_rad");
    const Real angle(csv.text(i, "crank_angle_rad"));
    // The tables have 20 digits and decimal lengths, which are doubles here. Their forces may grow as 1/offset.
    const Real left = 2 * test::realPi() - angle;
    const double offset = static_cast<double>(angle < left ? angle : left);
    const double tolerance = 1e-14 + 1e-19 / offset;
    const test::Reference r =
        exact.at(angle, Real(csv.text(i, "crank_speed_rad_s")), Real(csv.text(i, "crank_accel_rad_s2")),
                 {g * std::sin(pitch), -g * std::cos(pitch)});
    const auto equal = [&](const Real& value, const std::string& column, double size) {
      EXPECT_NEAR(static_cast<double>(value), csv.number(i, column), tolerance * size) << column << ' ' << i;
    };
    const auto equal_force = [&](const test::Vector& force, const std::string& name) {
      const double size = std::hypot(csv.number(i, name + "_x_N"), csv.number(i, name + "_z_N"));
      equal(force.x, name + "_x_N", size), equal(force.y, name + "_z_N", size);
    };
    for (const auto& [value, column] :
         {std::pair{r.psi, "rocker_angle_rad"}, std::pair{r.beta, "rod_angle_rad"},
          std::pair{r.psi_rate, "rocker_speed_rad_s"}, std::pair{r.psi_accel, "rocker_accel_rad_s2"},
          std::pair{r.hull_torque, "hull_torque_y_Nm"}, std::pair{r.drive_torque, "drive_torque_y_Nm"}})
      equal(value, column, csv.peak(column));
    equal_force(r.r01, "R01"), equal_force(r.r12, "R12"), equal_force(r.r23, "R23"), equal_force(r.r03, "R03");
    equal(r.hull_force.x, "hull_force_x_N", csv.peak("hull_force_x_N"));
    equal(r.hull_force.y, "hull_force_z_N", csv.peak("hull_force_z_N"));
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, NewtonEulerTest,
                         testing::Values(std::pair{"mo100_constant_speed.csv", Level::kRocker},
                                         std::pair{"mo100_linkage.csv", Level::kLinkage}));

}  // namespace
}  // namespace hammer_loads
