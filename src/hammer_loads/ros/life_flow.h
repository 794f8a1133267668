/// Messages and ledger entries of a run's turn loads and load cycles.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/JointState.h>

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/hammer_outputs.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

class LifeFlow {
 public:
  /// Refers to pipeline and outputs, which must outlive it. pieces: additional receiver of the counts, which must
  /// outlive it, too; null: none.
  LifeFlow(const Pipeline& pipeline, const Settings& settings, HammerOutputs& outputs, life::PieceSink* pieces);

  /// Takes the pipeline's result for a crank message; the first messages identify the run.
  void follow(const sensor_msgs::JointState& message, const ros::Time& record_time);
  /// Takes the revolutions that Pipeline::end() has ended.
  void end() { follower_.end(); }
  /// Sends the loads of a revolution, one of the ends of the result just followed.
  void sendTurn(const TurnEnd& end, const ros::Time& record_time);
  /// Sends the counts at the record time of the last message. No further call may follow.
  void finish();

  bool begun() const { return first_.has_value(); }
  const LifeFollower& follower() const { return follower_; }
  const life::LedgerMachine& machine() const { return machine_; }  ///< machine of the counts
  std::int64_t period() const { return period_; }                  ///< period of ~load_cycles and pieces [ns]
  /// Returns the numbers of samples of each channel since the count began.
  std::vector<life::SampleTally> tallies() const;
  /// Returns warnings of loads beyond their full scale, with the keys that set it. Not for the hot path.
  std::vector<Warning> warnings() const;

 private:
  void mark(const sensor_msgs::JointState& message);
  void name();
  life::LifePiece takePiece();
  std::string contradiction() const;

  const Pipeline& pipeline_;
  LifeFollower follower_;
  HammerOutputs& outputs_;
  life::PieceSink* pieces_;
  life::LedgerMachine machine_;
  std::string parameters_;      ///< digest of the sensors' parameters
  SampleCounts counts_before_;  ///< counts at the start; counts continue from run to run
  std::int64_t period_;
  ros::Time record_time_;          ///< record time of the last message
  std::optional<StampNs> first_;   ///< header stamp of the first message
  std::uint64_t digest_{};         ///< digest of the first messages
  std::uint64_t messages_{};       ///< messages since the count began
  std::uint64_t messages_kept_{};  ///< messages in earlier pieces
  bool named_{};
  std::optional<StampNs> slot_;           ///< time slot of the previous message, for marks
  std::vector<std::int64_t> marks_;       ///< marks since the last piece
  std::vector<life::LifePiece> unnamed_;  ///< pieces of a run that is not identified yet
};

}  // namespace hammer_loads
