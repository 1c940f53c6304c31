// SPDX-License-Identifier: GPL-3.0-or-later
#include <QLabel>
#include <QLineEdit>
#include <QTreeWidget>
#include <QUdpSocket>

#include "app/workbench/docks/host_choice.h"
#include "app/workbench/docks/host_dock.h"
#include "gui_support.h"
#include "hand.h"
#include "tests/core/host/wire_writer.h"
#include "trimtab/host/encoder.h"

namespace trimtab::test {
namespace {

/// Two hosts, or two aircraft of one host, fly at different heights, so that a test can tell which is heard.
constexpr double kLowM = 2500, kHighM = 3500;

std::vector<std::byte> cigi(double heightM, std::uint32_t frame, int entity = 0) {
  AircraftState state;
  state.position = {Degrees{46.5}, Degrees{8.25}, Metres{heightM}};
  std::vector<std::byte> bytes = encodeCigiHost(state, frame, 0);
  constexpr std::size_t kEntityControl = 24, kEntityLow = kEntityControl + 3;
  EXPECT_EQ(std::to_integer<int>(bytes[kEntityControl]), 2);
  bytes[kEntityLow] = static_cast<std::byte>(entity);
  return bytes;
}

/// An Entity State of DIS that stands still, after the table of IEEE 1278.1.
std::vector<std::byte> dis(double heightM, unsigned entity, const char* marking, double seconds) {
  const Vec3 at = toEcef(GeodeticPosition{Degrees{46.5}, Degrees{8.25}, Metres{heightM}});
  WireWriter w(ByteOrder::big);
  w.begin(144).u8(0, 7).u8(1, 3).u8(2, 1).u8(3, 1).u16(8, 144).u16(12, 17).u16(14, 2).u16(16, entity);
  w.u32(4, static_cast<std::uint32_t>(seconds / 3600 * 2147483648.0) << 1U | 1U);
  w.u8(18, 1).u8(20, 1).u8(21, 2).u16(22, 225).f64(48, at.x).f64(56, at.y).f64(64, at.z);
  w.u8(88, 1).u8(128, 1).text(129, marking);
  return w.bytes;
}

class HostChoice : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    ASSERT_NO_FATAL_FAILURE(activate());
    w().resize(1600, 1000);
    QUdpSocket probe;
    ASSERT_TRUE(probe.bind(QHostAddress::LocalHost, 0));
    port_ = probe.localPort();
    probe.close();
    dock().setSender(QString::fromLatin1(link::kAnyone));
    dock().setPort(port_);
    ASSERT_TRUE(dock().connectHost().empty());
    w().dock(QStringLiteral("host"))->raise();
    ASSERT_TRUE(comesToFront("host"));
    hand_.emplace(w());
  }
  workbench::HostDock& dock() { return *w().panels().host; }
  workbench::HostChoicePanel& panel() { return *dock().findChild<workbench::HostChoicePanel*>(); }
  QTreeWidget& list() { return *panel().findChild<QTreeWidget*>(); }
  QString label(const char* name) {
    const QLabel* const found = labelNamed(panel(), QLatin1String(name));
    return found != nullptr ? found->text() : QString();
  }
  void send(QUdpSocket& from, const std::vector<std::byte>& bytes) {
    from.writeDatagram(reinterpret_cast<const char*>(bytes.data()), qint64(bytes.size()),
                       QHostAddress::LocalHost, port_);
  }
  /// Sends what the hosts send, again and again, until the condition holds.
  bool sendUntil(const std::function<void(std::uint32_t frame)>& all, const std::function<bool()>& holds) {
    return waitFor(
        [&] {
          all(++frame_);
          QTest::qWait(20);
          return holds();
        },
        15000);
  }
  double heightM() { return session().hasState() ? session().input().state.position.height.value() : 0; }
  bool flies(double wanted) { return std::abs(heightM() - wanted) < 1; }

  std::uint16_t port_ = 0;
  std::uint32_t frame_ = 0;
  std::optional<Hand> hand_;
};

TEST_F(HostChoice, listsAllSendersAndHearsTheOneThatIsChosen) {
  QUdpSocket first, second;
  const auto both = [&](std::uint32_t frame) {
    send(first, cigi(kHighM, frame));
    if (frame > 3) send(second, cigi(kLowM, frame));
  };
  ASSERT_TRUE(sendUntil(both, [&] { return list().topLevelItemCount() == 2 && flies(kLowM); }))
      << "a host that appears is followed: " << heightM();
  const QString its = QStringLiteral("127.0.0.1:%1").arg(first.localPort());
  EXPECT_EQ(list().topLevelItem(0)->text(0), QStringLiteral("127.0.0.1:%1").arg(second.localPort()));
  ASSERT_EQ(list().topLevelItem(1)->text(0), its);
  for (QWidget* each = list().parentWidget(); each != nullptr; each = each->parentWidget())
    if (auto* area = qobject_cast<QScrollArea*>(each)) area->ensureWidgetVisible(&list());
  hand_->click(*list().viewport(), list().visualItemRect(list().topLevelItem(1)).center(), its);
  ASSERT_EQ(list().currentItem(), list().topLevelItem(1));
  // The row stays chosen while numbers go on.
  EXPECT_TRUE(sendUntil(both, [&] { return list().topLevelItem(1)->text(2).toInt() > 10; }));
  EXPECT_EQ(list().currentItem(), list().topLevelItem(1));
  for (QWidget* each = list().parentWidget(); each != nullptr; each = each->parentWidget())
    if (auto* area = qobject_cast<QScrollArea*>(each))
      area->ensureWidgetVisible(panel().findChild<QPushButton*>());
  hand_->press(panel(), "Hear this one alone");
  EXPECT_TRUE(sendUntil(both, [&] { return flies(kHighM); })) << heightM();
  EXPECT_EQ(w().feed().receiver()->senders().allowed, its.toStdString());
  EXPECT_GT(w().feed().receiver()->senders().refused, 0u);
  EXPECT_TRUE(sendUntil(both, [&] { return list().topLevelItemCount() == 1; })) << "the other is not heard";
}

TEST_F(HostChoice, namesTheOtherEntitiesAndFollowsTheOneOfThePreset) {
  QUdpSocket host;
  const auto all = [&](std::uint32_t frame) {
    send(host, cigi(kLowM, 2 * frame));
    send(host, cigi(kHighM, 2 * frame + 1, 7));
  };
  ASSERT_TRUE(sendUntil(all, [&] { return flies(kLowM) && !label("Entities and views seen").isEmpty(); }));
  EXPECT_EQ(label("Entities and views seen"), "Other entities: 7");
  ASSERT_TRUE(w().draft().setText("host.entity", "7").empty());
  EXPECT_TRUE(sendUntil(all, [&] { return flies(kHighM); })) << "the link is opened again, for the other one";
}

TEST_F(HostChoice, followsTheDisEntityThatAPersonNames) {
  QUdpSocket host;
  const auto all = [&](std::uint32_t frame) {
    send(host, dis(kLowM, 5, "VIPER1", 100 + 0.02 * frame));
    send(host, dis(kHighM, 6, "EAGLE2", 100 + 0.02 * frame));
  };
  ASSERT_TRUE(sendUntil(all, [&] { return flies(kLowM); })) << "the first platform that comes";
  QLineEdit* name = nullptr;
  for (auto* each : panel().findChildren<QLineEdit*>())
    if (each->accessibleName() == QLatin1String("Own aircraft by name")) name = each;
  ASSERT_NE(name, nullptr);
  const auto type = [&](const char* text) {
    name->setFocus();
    name->selectAll();
    hand_->type(QLatin1String(text));
    hand_->key(Qt::Key_Return);
  };
  type("EAGLE2");
  EXPECT_TRUE(sendUntil(all, [&] { return flies(kHighM); })) << heightM();
  type("17:2:5");
  EXPECT_TRUE(sendUntil(all, [&] { return flies(kLowM); })) << heightM();
}

}  // namespace
}  // namespace trimtab::test
