#include "hammer_loads/boom/wrench.h"

namespace hammer_loads {

Wrench shifted(const Pose& X_QP, const Wrench& w_P) noexcept {
  Wrench w_Q;
  w_Q.force.noalias() = X_QP.linear() * w_P.force;
  w_Q.torque.noalias() = X_QP.linear() * w_P.torque;
  w_Q.torque += X_QP.translation().cross(w_Q.force);
  return w_Q;
}

}  // namespace hammer_loads
