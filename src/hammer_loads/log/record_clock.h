/// Record times of a node's inputs.
#pragma once

#include <ros/time.h>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Arrival times, made strictly increasing so that a log in time order is in the order of arrival. If simulated time
/// runs back (a looped bag, a restarted simulation), the clock restarts. A wall clock that is set back has no effect,
/// as only header stamps are used in computations.
class RecordClock {
 public:
  struct Tick {
    ros::Time time;   ///< record time of the input
    bool ran_back{};  ///< a state by time must be forgotten
  };

  Tick next(const ros::Time& arrival) {
    const bool ran_back = arrival < last_arrival_ && ros::Time::isSimTime();
    last_arrival_ = arrival;
    last_ = BagLog::nextRecordTime(arrival, ran_back ? ros::Time() : last_);
    return {last_, ran_back};
  }
  /// Time of the last input.
  const ros::Time& last() const { return last_; }

 private:
  ros::Time last_arrival_, last_;
};

}  // namespace hammer_loads
