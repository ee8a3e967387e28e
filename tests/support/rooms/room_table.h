#pragma once

#include <map>
#include <string>

#include "tests/support/rooms/room_trial.h"

namespace lobe::test {

/// Trials as Markdown: a row a room. Errors in percent, with standard errors.
std::string RoomHeading();
std::string RoomRow(const GeneratedRoom& room, const RoomTrial& trial);

/// How many rooms fail which bound, by what is in them.
class RoomTally {
 public:
  void Add(const GeneratedRoom& room, const RoomTrial& trial);
  std::string Table() const;

 private:
  struct Count {
    int rooms = 0, failing = 0, excused = 0;  ///< excused: fails, with a warning
    std::map<std::string, int> failures;
  };
  std::map<std::string, Count> by_feature_;
};

}  // namespace lobe::test
