/// Over which time and how many readings an estimate looks back: one vocabulary.
#pragma once

namespace hammer_loads::look_back {

// Turns of a hammer at work, which strikes some five times a second.
constexpr double kTurn = 0.2;                   ///< [s]: all that a turn holds was there
constexpr double kHalfTurn = 0.5 * kTurn;       ///< [s]: a sensor that speaks has said something
constexpr double kSomeTurns = 0.5;              ///< [s]: the least for a mean
constexpr double kFiveTurns = 1.0;              ///< [s]: what was there in each of them is no accident
constexpr double kTenTurns = 2.0 * kFiveTurns;  ///< [s]: a mean in which one turn more or less does not show

// Boom and hull vibrate at 2 to 40 Hz.
constexpr double kHeld = 0.01;  ///< [s]: a reading holds
constexpr double kLine = 0.02;  ///< [s]: a line through the last readings goes on

// A variance by n values is known to sqrt(2/n).
constexpr double kReadings = 200.0;       ///< to a tenth
constexpr double kManyReadings = 1000.0;  ///< to a twentieth

constexpr int kTurnsToKnow = 5;       ///< nothing is concluded before
constexpr double kManyTurns = 300.0;  ///< a minute at work

}  // namespace hammer_loads::look_back
