#include "ground_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "core/scene/gl/gl_api.h"
#include "core/scene/shaders/shared_constants.h"
#include "ground_tiles.h"

namespace trimtab::scene {

namespace {

constexpr int kTile = static_cast<int>(terrain::GroundShape::kTile);
/// A side of the square block that is uploaded at a time, texels.
constexpr int kBlock = 64;
constexpr int kBlocks = kGroundSide / kBlock;
constexpr std::size_t kBlockBytes = std::size_t{kBlock} * kBlock * 4;
/// A level that is there for fewer texels than this about the eye is not used yet.
constexpr double kLeastReach = 256;

struct BlockPlace {
  int column = 0, row = 0;
  friend bool operator==(const BlockPlace&, const BlockPlace&) = default;
};

/// One axis of a level's window: from `first` on there are blocks up to `end`. A block beyond the borders is
/// there too, so that colours between texels do not come around the torus.
struct Span {
  int first = 0, end = 0;
  bool opensLow = false, opensHigh = false;  ///< ground goes on past it

  Span(double eyeTexel, std::uint32_t texels) {
    const int last = (static_cast<int>(texels) + kBlock - 1) / kBlock;
    const double middle = std::clamp(std::round(eyeTexel / kBlock), -1e6, 1e6);
    first = std::max(std::min(static_cast<int>(middle) - kBlocks / 2, last + 1 - kBlocks), -1);
    end = std::min(first + kBlocks, last + 1);
    opensLow = first > -1;
    opensHigh = end < last + 1;
  }
};

struct Level {
  std::array<BlockPlace, std::size_t{kBlocks} * kBlocks> held;
  int firstColumn = 0, firstRow = 0;
  bool settled = false;  ///< the window has all its blocks
  double reach = 0;      ///< texels of level 0 about the eye

  Level() { forget(); }
  void forget() {
    held.fill({std::numeric_limits<int>::min(), 0});
    settled = false;
  }
  BlockPlace& at(BlockPlace place) {
    return held[static_cast<std::size_t>((place.row & (kBlocks - 1)) * kBlocks +
                                         (place.column & (kBlocks - 1)))];
  }
};

}  // namespace

struct GroundTexture::Impl {
  std::shared_ptr<const terrain::GroundPyramid> ground;
  std::unique_ptr<GroundTiles> tiles;
  std::vector<Level> levels;
  bool voids = false, complete = false;
  std::int32_t eyeColumn = 0, eyeRow = 0;
  double originColumn = 0, originRow = 0;  ///< the eye's post in texels of level 0
  GLuint texture = 0;
  std::uint64_t uploaded = 0;
  double reach = 0;  ///< of every level used, in its own texels; infinite: all of it is there
  std::size_t finest = 0, whole = 0;  ///< level used at the eye; level from which on all is there

  const terrain::GroundShape::Level& sizeOf(std::size_t l) const { return ground->shape().levels[l]; }

  void restart() {
    tiles.reset();
    if (ground) tiles = std::make_unique<GroundTiles>(ground, voids);
    for (Level& level : levels) level.forget();
    complete = false;
  }

  /// Returns the tile of a block; what lies past the borders repeats the last texels.
  GroundTiles::Tile tileOf(std::size_t l, BlockPlace block) const {
    const auto tile = [](int b, std::uint32_t texels) {
      return static_cast<std::uint32_t>(std::clamp(b * kBlock, 0, static_cast<int>(texels) - 1) / kTile);
    };
    return {static_cast<std::uint32_t>(l), tile(block.column, sizeOf(l).columns),
            tile(block.row, sizeOf(l).rows)};
  }

  void upload(std::size_t l, BlockPlace block, const GroundTiles::Tile& tile, const GroundPixels& pixels) {
    const int columns = static_cast<int>(sizeOf(l).columns), rows = static_cast<int>(sizeOf(l).rows);
    const int x0 = block.column * kBlock, y0 = block.row * kBlock;
    const int tileX = static_cast<int>(tile.column) * kTile, tileY = static_cast<int>(tile.row) * kTile;
    const int x = (block.column & (kBlocks - 1)) * kBlock, y = (block.row & (kBlocks - 1)) * kBlock;
    const auto give = [&](const std::uint32_t* from, int line) {
      glPixelStorei(GL_UNPACK_ROW_LENGTH, line);
      glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, y, static_cast<GLint>(l), kBlock, kBlock, 1, GL_RGBA,
                      GL_UNSIGNED_BYTE, from);
    };
    if (x0 >= 0 && y0 >= 0 && x0 + kBlock <= columns && y0 + kBlock <= rows) {
      give(&pixels[static_cast<std::size_t>((y0 - tileY) * kTile + (x0 - tileX))], kTile);
    } else {
      std::array<std::uint32_t, std::size_t{kBlock} * kBlock> edge;
      for (int j = 0; j < kBlock; ++j)
        for (int i = 0; i < kBlock; ++i) {
          const int c = std::clamp(x0 + i, 0, columns - 1) - tileX;
          const int r = std::clamp(y0 + j, 0, rows - 1) - tileY;
          edge[static_cast<std::size_t>(j * kBlock + i)] = pixels[static_cast<std::size_t>(r * kTile + c)];
        }
      give(edge.data(), 0);
    }
    levels[l].at(block) = block;
    uploaded += kBlockBytes;
  }

  struct Missing {
    BlockPlace block;
    double distance = 0;  ///< of the block from the eye, the larger of both directions, texels of its level
  };
  std::vector<Missing> missing;

  /// Finds the window about the eye, what it misses by distance, and how far it may be used.
  void look(std::size_t l) {
    Level& level = levels[l];
    const double scale = std::ldexp(1.0, -static_cast<int>(l));
    const double x = originColumn * scale, y = originRow * scale;
    const Span across(x, sizeOf(l).columns), up(y, sizeOf(l).rows);
    missing.clear();
    double least = std::numeric_limits<double>::infinity();
    const auto limit = [&](bool opens, double distance) {
      if (opens) least = std::min(least, std::max(distance, 0.0));
    };
    limit(across.opensLow, x - across.first * kBlock);
    limit(across.opensHigh, across.end * kBlock - x);
    limit(up.opensLow, y - up.first * kBlock);
    limit(up.opensHigh, up.end * kBlock - y);
    const bool same = level.settled && level.firstColumn == across.first && level.firstRow == up.first;
    if (!same) {
      level.firstColumn = across.first;
      level.firstRow = up.first;
      const auto distance = [](double eye, int block) {
        return std::max({block * kBlock - eye, eye - (block + 1) * kBlock, 0.0});
      };
      for (int r = up.first; r < up.end; ++r)
        for (int c = across.first; c < across.end; ++c)
          if (const BlockPlace block{c, r}; level.at(block) != block)
            missing.push_back({block, std::max(distance(x, c), distance(y, r))});
      std::sort(missing.begin(), missing.end(), [](const Missing& a, const Missing& b) {
        return std::tie(a.distance, a.block.row, a.block.column) <
               std::tie(b.distance, b.block.row, b.block.column);
      });
    }
    level.reach = least / scale;
  }

  void settle(std::size_t l, std::size_t done) {
    Level& level = levels[l];
    level.settled = done == missing.size();
    if (!level.settled) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Missing& m : missing)
        if (levels[l].at(m.block) != m.block) nearest = std::min(nearest, m.distance);
      level.reach = std::min(level.reach, std::ldexp(nearest, static_cast<int>(l)));
      complete = false;
    }
  }

  void update(bool wait, std::size_t mostBytes) {
    std::vector<GroundTiles::Tile> wanted;
    std::unordered_set<std::uint64_t> asked;
    std::size_t left = mostBytes;
    bool any = false;
    complete = true;
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    for (std::size_t l = levels.size(); l-- > 0;) {
      look(l);
      std::size_t done = 0;
      // The coarsest is what is shown where nothing else is there: it is one tile, and waited for.
      const bool now = wait || l + 1 == levels.size();
      std::uint64_t lastTile = ~std::uint64_t{0};
      std::shared_ptr<const GroundPixels> pixels;
      for (const Missing& m : missing) {
        const GroundTiles::Tile tile = tileOf(l, m.block);
        if (tile.key() != lastTile) {
          pixels = now ? tiles->readNow(tile) : tiles->find(tile);
          lastTile = tile.key();
          if (!pixels && !now && asked.insert(tile.key()).second) wanted.push_back(tile);
        }
        if (!pixels) continue;
        if (!now) {
          if (any && left < kBlockBytes) continue;
          left -= std::min(left, kBlockBytes);
          any = true;
        }
        upload(l, m.block, tile, *pixels);
        ++done;
      }
      settle(l, done);
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    tiles->want(std::move(wanted));
    allow();
  }

  /// Allows what the shader may use: a level, and with it all coarser ones.
  void allow() {
    reach = std::numeric_limits<double>::infinity();
    finest = whole = levels.size() - 1;
    for (std::size_t l = levels.size(); l-- > 0;) {
      // A place between texels needs the ones beside it.
      const double own = std::ldexp(levels[l].reach, -static_cast<int>(l)) - 1.5;
      if (own < kLeastReach && l + 1 < levels.size()) break;
      if (std::isinf(own) && std::isinf(reach)) whole = l;
      reach = std::min(reach, own);
      finest = l;
    }
  }
};

GroundTexture::GroundTexture() : impl_(std::make_unique<Impl>()) {}

GroundTexture::~GroundTexture() {
  if (impl_->texture != 0) glDeleteTextures(1, &impl_->texture);
}

void GroundTexture::setGround(std::shared_ptr<const terrain::GroundPyramid> ground) {
  Impl& my = *impl_;
  my.ground = std::move(ground);
  const std::size_t wanted = my.ground ? std::min<std::size_t>(my.ground->shape().levels.size(), kLevels) : 0;
  if (wanted != my.levels.size()) {
    if (my.texture != 0) glDeleteTextures(1, &my.texture);
    my.texture = 0;
    my.levels.assign(wanted, {});
  }
  my.restart();
  if (wanted == 0) return;
  if (my.texture != 0) return;
  glGenTextures(1, &my.texture);
  glBindTexture(GL_TEXTURE_2D_ARRAY, my.texture);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, kGroundSide, kGroundSide, static_cast<GLsizei>(wanted));
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
}

void GroundTexture::showVoids(bool show) {
  if (impl_->voids == show) return;
  impl_->voids = show;
  impl_->restart();
}

void GroundTexture::update(double column, double row, bool wait, std::size_t mostBytes) {
  Impl& my = *impl_;
  const auto whole = [](double post) {
    return static_cast<std::int32_t>(std::floor(std::clamp(post, -1e6, 2e6)));
  };
  my.eyeColumn = whole(column);
  my.eyeRow = whole(row);
  if (!my.tiles) return;
  const double texels = my.ground->shape().texelsPerPost;
  my.originColumn = my.eyeColumn * texels;
  my.originRow = my.eyeRow * texels;
  my.update(wait, mostBytes);
}

std::int32_t GroundTexture::eyeColumn() const {
  return impl_->eyeColumn;
}
std::int32_t GroundTexture::eyeRow() const {
  return impl_->eyeRow;
}

void GroundTexture::bind(unsigned program, double coarser) const {
  const Impl& my = *impl_;
  const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
  glUniform1i(uniform("groundTexels"), kGroundUnit);
  if (!my.tiles) return;
  // ground_colour.glsl has levels as the bits of floats.
  const auto setLevel = [&](const char* name, double level) {
    glUniform1i(uniform(name), static_cast<int>(std::lround(std::ldexp(level, 23))));
  };
  constexpr double kBias = 127;
  const double texels = my.ground->shape().texelsPerPost;
  glUniform2f(uniform("groundOrigin"), static_cast<float>(my.originColumn), static_cast<float>(my.originRow));
  glUniform1f(uniform("groundTexelsPerPost"), static_cast<float>(texels));
  glUniform1f(uniform("groundShift"), static_cast<float>(my.ground->shape().texelOf(0)));
  setLevel("groundLast", static_cast<double>(my.levels.size() - 1) + kBias);
  glUniform1f(uniform("groundReach"), static_cast<float>(1 / std::max(my.reach, 1e-3)));
  setLevel("groundFinest", static_cast<double>(my.finest) + kBias);
  setLevel("groundWhole", static_cast<double>(my.whole) + kBias);
  setLevel("groundCoarser", std::log2(std::max(coarser, 1.0)));
  glActiveTexture(GL_TEXTURE0 + kGroundUnit);
  glBindTexture(GL_TEXTURE_2D_ARRAY, my.texture);
  glActiveTexture(GL_TEXTURE0);
}

void GroundTexture::unbind() const {
  glActiveTexture(GL_TEXTURE0 + kGroundUnit);
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
  glActiveTexture(GL_TEXTURE0);
}

std::size_t GroundTexture::bytes() const {
  return impl_->levels.size() * kGroundSide * kGroundSide * 4 + (impl_->tiles ? impl_->tiles->bytes() : 0);
}
std::uint64_t GroundTexture::bytesUploaded() const {
  return impl_->uploaded;
}
bool GroundTexture::complete() const {
  return impl_->complete;
}
std::size_t GroundTexture::failed() const {
  return impl_->tiles ? impl_->tiles->failed() : 0;
}
Findings GroundTexture::failures() const {
  return impl_->tiles ? impl_->tiles->failures() : Findings{};
}

}  // namespace trimtab::scene
