/// Record times of a node's inputs.
#pragma once

#include <ros/time.h>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Arrival times, made strictly increasing so that a log read back in time order is in the order of arrival. Simulated
/// time that runs back (a bag that loops, a simulation that starts again) restarts; a wall clock that is set back
/// changes nothing, for header stamps are the only time that is computed with.
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
