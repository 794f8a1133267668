/// Times and numbers of readings over which estimates look back.
#pragma once

namespace hammer_loads::look_back {

// Revolutions of a hammer at work, which strikes some five times a second.
constexpr double kTurn = 0.2;                   ///< [s]: contains all events of a revolution
constexpr double kHalfTurn = 0.5 * kTurn;       ///< [s]: an active sensor has sent a reading
constexpr double kSomeTurns = 0.5;              ///< [s]: shortest time for a mean
constexpr double kFiveTurns = 1.0;              ///< [s]: an event in each of them is no accident
constexpr double kTenTurns = 2.0 * kFiveTurns;  ///< [s]: one revolution more or less hardly changes a mean

// Boom and hull vibrate at 2 to 40 Hz.
constexpr double kHeld = 0.01;  ///< [s]: validity of a reading
constexpr double kLine = 0.02;  ///< [s]: validity of a line through the last readings

// A variance from n values has a relative standard deviation of sqrt(2/n).
constexpr double kReadings = 200.0;       ///< a tenth
constexpr double kManyReadings = 1000.0;  ///< a twentieth

constexpr int kTurnsToKnow = 5;       ///< no conclusion before
constexpr double kManyTurns = 300.0;  ///< a minute at work

}  // namespace hammer_loads::look_back
