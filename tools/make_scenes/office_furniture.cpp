// SPDX-License-Identifier: MIT
#include <string>

#include "tools/make_scenes/furniture.h"
#include "tools/make_scenes/office.h"

namespace camway::make_scenes {
namespace {

using namespace office;

/// Furniture of one room, in coordinates seen from the door: `u` to the right of the room's centre,
/// and `depth` away from the corridor.
class Furnisher {
 public:
  Furnisher(Scene& scene, int storey, const Room& room, Dice& dice)
      : scene_(scene), storey_(storey), room_(room), dice_(dice) {}

  /// With `turn` 0 the piece faces away from the corridor.
  [[nodiscard]] Placement at(Um u, Um depth, const Turn& turn = kTurn0) const {
    const Um x = room_.middle_x() + (room_.north ? u : -u);
    return {{x, floor_y(storey_), room_.z_at(depth)}, room_.north ? compose(turn, kTurn180) : turn};
  }

  void begin(const std::string& kind) {
    scene_.begin_object(kind + '_' + std::to_string(storey_) + '_' + room_.name + '_' +
                        std::to_string(count_++));
  }

  [[nodiscard]] Um half_width() const { return (room_.x1 - room_.x0) / 2; }

  void lamp(Um u, Um depth) {
    begin("lamp");
    add_lamp(scene_, at(u, depth));
  }
  void plant(Um u, Um depth) {
    begin("plant");
    add_plant(scene_, at(u, depth), dice_);
  }
  void chair(Um u, Um depth, const Turn& turn) {
    begin("chair");
    add_chair(scene_, at(u, depth, turn));
  }
  void shelf(Um u, Um depth, const Turn& turn, Um length) {
    begin("shelf");
    add_shelf(scene_, at(u, depth, turn), length, dice_);
  }
  void desk(Um u, Um depth, const Turn& turn) {
    begin("desk");
    add_desk(scene_, at(u, depth, turn));
  }
  void table(Um u, Um depth, const Turn& turn, Um length, Um width, Um height) {
    begin("table");
    add_table(scene_, at(u, depth, turn), length, width, height);
  }

 private:
  Scene& scene_;
  int storey_;
  const Room& room_;
  Dice& dice_;
  int count_ = 0;
};

/// Desks along both side walls, an aisle in the middle.
void furnish_office(Furnisher& room) {
  const Um wall = room.half_width();
  for (const Um depth : {mm(3600), mm(6200)}) {
    room.desk(wall - mm(450), depth, kTurn90);
    room.desk(-wall + mm(450), depth, kTurn270);
    room.chair(wall - mm(1150), depth - mm(100), compose(kTurn270, kTurn23));
    room.chair(-wall + mm(1150), depth + mm(150), compose(kTurn90, kTurnMinus28));
  }
  room.shelf(-wall + mm(200), mm(2330), kTurn270, mm(900));
  room.lamp(wall - mm(400), mm(7600));
  room.plant(-wall + mm(500), mm(7500));
}

/// A long table with eight chairs.
void furnish_meeting(Furnisher& room) {
  const Um middle = mm(5000);
  room.table(0, middle, kTurn270, mm(3000), mm(1300), mm(740));
  for (const Um offset : {mm(-950), mm(0), mm(950)}) {
    room.chair(mm(850), middle + offset, kTurn90);
    room.chair(mm(-850), middle + offset, kTurn270);
  }
  room.chair(0, middle + mm(1850), kTurn180);
  room.chair(0, middle - mm(1850), kTurn23);
  room.shelf(room.half_width() - mm(200), mm(5000), kTurn90, mm(1800));
  room.plant(-room.half_width() + mm(500), mm(7500));
  room.lamp(room.half_width() - mm(450), mm(7500));
}

/// Free-standing shelves on both sides of an aisle.
void furnish_library(Furnisher& room) {
  const Um wall = room.half_width();
  const Um length = mm(1500);
  for (const Um depth : {mm(2700), mm(4300), mm(5900)}) {
    room.shelf(wall - length / 2 - mm(200), depth, kTurn0, length);
    room.shelf(-wall + length / 2 + mm(200), depth, kTurn0, length);
  }
  room.table(0, mm(7300), kTurn0, mm(1600), mm(700), mm(740));
  room.lamp(wall - mm(450), mm(7500));
}

/// A low table, chairs at odd angles, plants.
void furnish_lounge(Furnisher& room) {
  const Um wall = room.half_width();
  room.table(0, mm(5200), kTurn37, mm(1100), mm(700), mm(450));
  room.chair(mm(1200), mm(5400), compose(kTurn90, kTurn23));
  room.chair(mm(-1200), mm(5000), compose(kTurn270, kTurnMinus28));
  room.chair(mm(200), mm(6500), compose(kTurn180, kTurn37));
  room.shelf(wall - mm(200), mm(3000), kTurn90, mm(1400));
  room.plant(wall - mm(500), mm(7500));
  room.plant(-wall + mm(500), mm(2700));
  room.lamp(-wall + mm(450), mm(7500));
  room.lamp(mm(1900), mm(4200));
}

}  // namespace

void furnish_room(Scene& scene, int storey, std::size_t room_index, Dice& dice) {
  const Room& room = kRooms[room_index];
  Furnisher furnisher(scene, storey, room, dice);
  if (storey == 0 && room_index == 7) {
    scene.begin_object("safe");
    add_safe(scene, {{kSafeX, floor_y(0), kSafeZ}});
    furnisher.table(0, mm(5000), kTurn0, mm(2200), mm(900), mm(740));
    furnisher.chair(mm(300), mm(5900), kTurn180);
    furnisher.lamp(mm(-2000), mm(7200));
    return;
  }
  if (room_index == 2) {  // the shaft takes a corner of it
    furnisher.desk(mm(2000), mm(3600), kTurn90);
    furnisher.chair(mm(1300), mm(3600), kTurn270);
    furnisher.plant(mm(2300), mm(7400));
    return;
  }
  constexpr auto kStyles = std::array{&furnish_office, &furnish_meeting, &furnish_office,
                                      &furnish_lounge, &furnish_library};
  const std::size_t style =
      (room_index * 2 + static_cast<std::size_t>(storey) * 3) % kStyles.size();
  kStyles[style](furnisher);
}

void furnish_atrium(Scene& scene, Dice& dice) {
  const Um middle_x = (kAtriumX0 + kAtriumX1) / 2;
  int number = 0;
  for (const Um z : {mm(14600), mm(17100)}) {
    for (const Um x : {mm(13400), mm(16600)}) {
      scene.begin_object("bench_" + std::to_string(number));
      add_bench(scene, {{x, 0, z}, kTurn90}, mm(1500));
      scene.begin_object("plant_atrium_" + std::to_string(number++));
      add_plant(scene, {{x < middle_x ? mm(12500) : mm(17500), 0, z}}, dice);
    }
  }
  scene.begin_object("desk_reception");
  add_desk(scene, {{middle_x, 0, mm(18600)}, kTurn180});
  // Hangs from the roof's underside by a cable of 2 cm.
  scene.begin_object("pendant");
  const Um top = floor_y(kStoreys) - kSlabThickness;
  scene.add_prism({}, {middle_x, top - mm(2500), mm(15850)}, mm(10), mm(2500), 6);
  scene.add_prism({}, {middle_x, top - mm(3000), mm(15850)}, mm(450), mm(500), 12);
}

}  // namespace camway::make_scenes
