// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>
#include <imgui.h>

#include <memory>
#include <string>

#include "model/comparison.h"
#include "model/navigator.h"
#include "work/shown.h"

namespace lamina::view {

// A picture as a texture of the window's OpenGL.
class PictureTexture {
  public:
    explicit PictureTexture(const GladGLContext& gl);
    ~PictureTexture();
    PictureTexture(const PictureTexture&) = delete;
    PictureTexture& operator=(const PictureTexture&) = delete;

    void show(const ScreenPicture& picture);
    GLuint name() const { return name_; }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    const GladGLContext& gl_;
    GLuint name_ = 0;
    int width_ = 0, height_ = 0;
};

// Draws the comparison of two pictures in the picture's area of the window.
class ComparisonView {
  public:
    explicit ComparisonView(const GladGLContext& gl);

    // Draws an active comparison over the picture in `area`. `a`, `b`: names of its pictures.
    void draw(Comparison& comparison, const PictureArea& area, const std::string& a,
              const std::string& b);

  private:
    // A texture, and the picture that it shows.
    struct Slot {
        explicit Slot(const GladGLContext& gl) : texture(gl) {}
        void take(const std::shared_ptr<const ScreenPicture>& picture);
        ImTextureID id() const;
        PictureTexture texture;
        std::shared_ptr<const ScreenPicture> shown;
    };

    void draw_wipe(Comparison& comparison, const std::string& a, const std::string& b);
    void draw_side_by_side(const std::string& a, const std::string& b);
    void draw_difference(Comparison& comparison);

    Slot other_, edited_, colors_;
    ImVec2 min_{}, max_{};  // corners of the picture in the window
};

}  // namespace lamina::view
