// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw_thread.h"

#include <sys/resource.h>

#include <utility>

#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::workbench {
namespace {

/// The thread gets about a tenth of what the image gets where both want the processor.
constexpr int kNice = 10;

}  // namespace

struct DrawThread::Inside {
  std::unique_ptr<scene::Offscreen> surface;
  std::unique_ptr<scene::ErrorMeter> meter;
  std::shared_ptr<const terrain::Database> terrain;
  bool tried = false;

  Findings open() {
    tried = true;
    // The rasteriser's own threads, which the context starts, inherit it.
    ::setpriority(PRIO_PROCESS, 0, kNice);
    auto made = scene::Offscreen::create(16, 16);
    if (!made) return made.findings();
    surface = std::move(made).value();
    surface->makeCurrent();
    auto fresh = std::make_unique<scene::ErrorMeter>();
    if (const scene::GlReport gl = fresh->initialize(); !gl.usable) {
      surface.reset();
      return {
          {Severity::error, "OpenGL without a window", gl.renderer, "what the renderer needs", gl.missing}};
    }
    meter = std::move(fresh);
    meter->setTerrain(terrain);
    return {};
  }
  void close() {
    if (meter) meter->release();
    meter.reset();
    surface.reset();
  }
};

DrawThread::DrawThread(QObject* parent)
    : QObject(parent), worker_(new QObject), inside_(std::make_unique<Inside>()) {
  worker_->moveToThread(&thread_);
  thread_.setObjectName(QStringLiteral("measuring"));
  thread_.start();
}

DrawThread::~DrawThread() {
  QMetaObject::invokeMethod(
      worker_, [this] { inside_->close(); }, Qt::BlockingQueuedConnection);
  thread_.quit();
  thread_.wait();
  delete worker_;
}

void DrawThread::setTerrain(std::shared_ptr<const terrain::Database> terrain) {
  QMetaObject::invokeMethod(worker_, [this, terrain = std::move(terrain)] {
    inside_->terrain = terrain;
    if (inside_->meter) inside_->meter->setTerrain(terrain);
  });
}

void DrawThread::setHeld(bool held) {
  held_ = held;
  if (!held_)
    for (const auto& run : std::exchange(waiting_, {})) run();
}

void DrawThread::run(std::function<void(scene::ErrorMeter&)> work, QObject* receiver,
                     std::function<void()> done) {
  if (held_)
    return waiting_.push_back([this, work = std::move(work), receiver = QPointer<QObject>(receiver),
                               done = std::move(done)] { run(work, receiver, done); });
  QMetaObject::invokeMethod(worker_, [this, work = std::move(work), receiver = QPointer<QObject>(receiver),
                                      done = std::move(done)] {
    if (!inside_->tried)
      if (Findings findings = inside_->open(); !findings.empty())
        QMetaObject::invokeMethod(this, [this, findings] {
          missing_ = findings;
          emit failed(findings);
        });
    if (inside_->meter == nullptr) return;
    work(*inside_->meter);
    QMetaObject::invokeMethod(this, [receiver, done] {
      if (receiver) done();
    });
  });
}

}  // namespace trimtab::workbench
