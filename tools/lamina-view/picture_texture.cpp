// SPDX-License-Identifier: Apache-2.0
#include "picture_texture.h"

namespace lamina::view {

// Interpolation changes nothing if a pixel of the picture covers one of the screen.
PictureTexture::PictureTexture(const GladGLContext& gl) : gl_(gl) {
    gl_.GenTextures(1, &name_);
    gl_.BindTexture(GL_TEXTURE_2D, name_);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

PictureTexture::~PictureTexture() {
    gl_.DeleteTextures(1, &name_);
}

void PictureTexture::show(const ScreenPicture& picture) {
    gl_.BindTexture(GL_TEXTURE_2D, name_);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (picture.width == width_ && picture.height == height_) {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE,
                          picture.rgb.data());
        return;
    }
    width_ = picture.width;
    height_ = picture.height;
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_RGB, GL_UNSIGNED_BYTE,
                   picture.rgb.data());
}

}  // namespace lamina::view
