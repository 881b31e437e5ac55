// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include "work/shown.h"

namespace lamina::view {

// The picture as a texture of the window's OpenGL.
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

}  // namespace lamina::view
