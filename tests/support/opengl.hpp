#pragma once

// A real OpenGL, headless: EGL's surfaceless platform and the compatibility profile. Everything is loaded at run time
// and declared here, so that neither headers nor libraries of OpenGL are needed to build the tests. There is no default
// framebuffer; drawing goes to a target of four floats a pixel.

#if __has_include(<dlfcn.h>)
#include <dlfcn.h>
#endif

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace support::gl {

using Enum = unsigned;

// EGL 1.5.
inline constexpr Enum egl_opengl_api = 0x30A2, egl_none = 0x3038, egl_renderable_type = 0x3040, egl_opengl_bit = 8;
inline constexpr Enum egl_surface_type = 0x3033, egl_pbuffer_bit = 1;
inline constexpr Enum egl_context_profile_mask = 0x30FD, egl_context_compatibility_bit = 2;

// OpenGL 1.1 to 3.0.
inline constexpr Enum points = 0, triangles = 4;
inline constexpr Enum no_error = 0, invalid_enum = 0x0500;
inline constexpr Enum float_type = 0x1406, rgba = 0x1908, rgba32f = 0x8814;
inline constexpr Enum modelview = 0x1700, projection = 0x1701, texture = 0x1702;
inline constexpr Enum render = 0x1C00, feedback = 0x1C01, four_d_color_texture = 0x0604, point_token = 0x0701;
inline constexpr Enum texture_gen_s = 0x0C60;  // T, R, Q follow
inline constexpr Enum s = 0x2000;              // T, R, Q follow
inline constexpr Enum texture_gen_mode = 0x2500, object_plane = 0x2501, eye_plane = 0x2502;
inline constexpr Enum eye_linear = 0x2400, object_linear = 0x2401, sphere_map = 0x2402;
inline constexpr Enum normal_map = 0x8511, reflection_map = 0x8512;
inline constexpr Enum normalize = 0x0BA1, rescale_normal = 0x803A;
inline constexpr Enum texture_2d = 0x0DE1, texture_mag_filter = 0x2800, texture_min_filter = 0x2801, nearest = 0x2600;
inline constexpr Enum linear = 0x2601, linear_mipmap_linear = 0x2703;
inline constexpr Enum framebuffer = 0x8D40, color_attachment0 = 0x8CE0, framebuffer_complete = 0x8CD5;
inline constexpr Enum color_buffer_bit = 0x4000;
inline constexpr Enum fragment_shader = 0x8B30, vertex_shader = 0x8B31, compile_status = 0x8B81, link_status = 0x8B82;
inline constexpr Enum texture_wrap_s = 0x2802, texture_wrap_t = 0x2803, clamp_to_edge = 0x812F,
                      clamp_to_border = 0x812D;
inline constexpr Enum texture_border_color = 0x1004, depth_component = 0x1902, depth_component24 = 0x81A6;
inline constexpr Enum texture_compare_mode = 0x884C, texture_compare_func = 0x884D, compare_ref_to_texture = 0x884E;
inline constexpr Enum less_or_equal = 0x0203;
inline constexpr Enum clamp_vertex_color = 0x891A, clamp_fragment_color = 0x891B, clamp_read_color = 0x891C;
inline constexpr Enum renderer = 0x1F01, version = 0x1F02;

class Context {
public:
    static constexpr int width = 256, height = 256;

    // The one context of the program; null where there is none, and reason() says why.
    static const Context* instance() {
        static const Context context;
        return context.usable_ ? &context : nullptr;
    }
    // The same, or the end of the program, as skipped.
    static const Context& or_skip() {
        const Context* const context = instance();
        if (context == nullptr) {
            std::fprintf(stderr, "skipped: %s\n", reason().c_str());
            std::exit(77);
        }
        return *context;
    }
    static std::string& reason() {
        static std::string text;
        return text;
    }

    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    void (*Begin)(Enum) = nullptr;
    void (*End)() = nullptr;
    void (*Vertex3fv)(const float*) = nullptr;
    void (*Vertex4fv)(const float*) = nullptr;
    void (*Normal3fv)(const float*) = nullptr;
    void (*TexCoord4fv)(const float*) = nullptr;
    void (*MatrixMode)(Enum) = nullptr;
    void (*LoadIdentity)() = nullptr;
    void (*LoadMatrixf)(const float*) = nullptr;
    void (*Enable)(Enum) = nullptr;
    void (*Disable)(Enum) = nullptr;
    void (*TexGeni)(Enum, Enum, int) = nullptr;
    void (*TexGenfv)(Enum, Enum, const float*) = nullptr;
    void (*GetTexGeniv)(Enum, Enum, int*) = nullptr;
    void (*GetTexGenfv)(Enum, Enum, float*) = nullptr;
    unsigned char (*IsEnabled)(Enum) = nullptr;
    Enum (*GetError)() = nullptr;
    const unsigned char* (*GetString)(Enum) = nullptr;
    int (*RenderMode)(Enum) = nullptr;
    void (*FeedbackBuffer)(int, Enum, float*) = nullptr;
    void (*GenTextures)(int, unsigned*) = nullptr;
    void (*BindTexture)(Enum, unsigned) = nullptr;
    void (*TexImage2D)(Enum, int, int, int, int, int, Enum, Enum, const void*) = nullptr;
    void (*TexParameteri)(Enum, Enum, int) = nullptr;
    void (*GenFramebuffers)(int, unsigned*) = nullptr;
    void (*BindFramebuffer)(Enum, unsigned) = nullptr;
    void (*FramebufferTexture2D)(Enum, Enum, Enum, unsigned, int) = nullptr;
    Enum (*CheckFramebufferStatus)(Enum) = nullptr;
    void (*Viewport)(int, int, int, int) = nullptr;
    void (*ClampColor)(Enum, Enum) = nullptr;
    void (*ClearColor)(float, float, float, float) = nullptr;
    void (*Clear)(Enum) = nullptr;
    void (*ReadPixels)(int, int, int, int, Enum, Enum, void*) = nullptr;
    unsigned (*CreateShader)(Enum) = nullptr;
    void (*ShaderSource)(unsigned, int, const char* const*, const int*) = nullptr;
    void (*CompileShader)(unsigned) = nullptr;
    void (*GetShaderiv)(unsigned, Enum, int*) = nullptr;
    unsigned (*CreateProgram)() = nullptr;
    void (*AttachShader)(unsigned, unsigned) = nullptr;
    void (*LinkProgram)(unsigned) = nullptr;
    void (*GetProgramiv)(unsigned, Enum, int*) = nullptr;
    void (*UseProgram)(unsigned) = nullptr;
    void (*GetShaderInfoLog)(unsigned, int, int*, char*) = nullptr;
    void (*BindAttribLocation)(unsigned, unsigned, const char*) = nullptr;
    int (*GetUniformLocation)(unsigned, const char*) = nullptr;
    void (*Uniform1f)(int, float) = nullptr;
    void (*Uniform3fv)(int, int, const float*) = nullptr;
    void (*Uniform4fv)(int, int, const float*) = nullptr;
    void (*UniformMatrix4fv)(int, int, unsigned char, const float*) = nullptr;
    void (*TexParameterfv)(Enum, Enum, const float*) = nullptr;

    void load_matrix(Enum mode, const glm::mat4& matrix) const {
        MatrixMode(mode);
        LoadIdentity();  // Mesa 22.3 leaves a stale inverse behind a projective matrix that is replaced at once
        LoadMatrixf(&matrix[0][0]);
    }

    // All texgen off, modes, planes, matrices and normal treatments as a new context has them.
    void reset() const {
        UseProgram(0);
        for (const Enum mode : {projection, texture, modelview}) load_matrix(mode, glm::mat4(1.0f));
        for (Enum i = 0; i < 4; ++i) {
            const glm::vec4 plane(i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, 0.0f, 0.0f);
            Disable(texture_gen_s + i);
            TexGeni(s + i, texture_gen_mode, static_cast<int>(eye_linear));
            TexGenfv(s + i, object_plane, &plane[0]);
            TexGenfv(s + i, eye_plane, &plane[0]);
        }
        Disable(normalize);
        Disable(rescale_normal);
    }

    // A program of these shaders, the fixed functions for vertices where there is none; 0 where one does not compile,
    // and reason() has the log. Vec3 `position` is what Vertex3fv gives.
    unsigned program(const char* vertex_source, const char* fragment_source) const {
        const unsigned result = CreateProgram();
        for (const auto& [kind, source] :
             {std::pair(vertex_shader, vertex_source), std::pair(fragment_shader, fragment_source)}) {
            if (source == nullptr) continue;
            const unsigned shader = CreateShader(kind);
            ShaderSource(shader, 1, &source, nullptr);
            CompileShader(shader);
            int compiled = 0;
            GetShaderiv(shader, compile_status, &compiled);
            if (compiled == 0) {
                char log[1024] = {};
                GetShaderInfoLog(shader, sizeof log, nullptr, log);
                reason() = log;
                return 0;
            }
            AttachShader(result, shader);
        }
        BindAttribLocation(result, 0, "position");
        LinkProgram(result);
        int linked = 0;
        GetProgramiv(result, link_status, &linked);
        return linked != 0 ? result : 0;
    }

    // Fragments get gl_TexCoord[0] as their color.
    void show_texcoord() const { UseProgram(program_); }

    // The texture coordinate that a vertex gets, by feedback. PROJECTION must keep it inside the view.
    // Not valid unless exactly one point comes back.
    struct Feedback {
        bool valid;
        glm::vec4 texcoord;
    };
    Feedback vertex_texcoord(const glm::vec4& position, const glm::vec3& normal, const glm::vec4& texcoord) const {
        float buffer[64] = {};
        FeedbackBuffer(64, four_d_color_texture, buffer);
        RenderMode(feedback);
        Begin(points);
        Normal3fv(&normal[0]);
        TexCoord4fv(&texcoord[0]);
        Vertex4fv(&position[0]);
        End();
        // A token, then position, color and texture coordinate, four floats each.
        const int count = RenderMode(render);
        return {count == 13 && buffer[0] == static_cast<float>(point_token),
                {buffer[9], buffer[10], buffer[11], buffer[12]}};
    }

    void clear(const glm::vec4& color) const {
        ClearColor(color.x, color.y, color.z, color.w);
        Clear(color_buffer_bit);
    }

    std::vector<glm::vec4> pixels() const {
        std::vector<glm::vec4> result(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        ReadPixels(0, 0, width, height, rgba, float_type, result.data());
        return result;
    }

private:
    Context() : usable_(create()) {}

    static bool failed(const char* why) {
        reason() = why;
        return false;
    }

    using Function = void (*)();
    Function (*get_proc_address_)(const char*) = nullptr;

    template <class Pointer>
    bool load(Pointer& pointer, const char* name) {
        pointer = reinterpret_cast<Pointer>(get_proc_address_(name));
        return pointer != nullptr;
    }

    bool create() {
#if __has_include(<dlfcn.h>)
        // Those who run the tests may choose another OpenGL.
        setenv("EGL_PLATFORM", "surfaceless", 0);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
        setenv("GALLIUM_DRIVER", "llvmpipe", 0);
        setenv("LP_NUM_THREADS", "1", 0);
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
        void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
        if (!library) return failed("libEGL.so.1 is not there");
        get_proc_address_ = reinterpret_cast<Function (*)(const char*)>(dlsym(library, "eglGetProcAddress"));
        if (!get_proc_address_) return failed("libEGL.so.1 has no eglGetProcAddress");
        return create_context() && load_functions() && create_target() && create_program();
#else
        return failed("this platform has no dlopen");
#endif
    }

    bool create_context() {
        void* (*get_display)(void*) = nullptr;
        unsigned (*initialize)(void*, int*, int*) = nullptr;
        unsigned (*bind_api)(Enum) = nullptr;
        unsigned (*choose_config)(void*, const int*, void**, int, int*) = nullptr;
        void* (*make_context)(void*, void*, void*, const int*) = nullptr;
        unsigned (*make_current)(void*, void*, void*, void*) = nullptr;
        if (!load(get_display, "eglGetDisplay") || !load(initialize, "eglInitialize") ||
            !load(bind_api, "eglBindAPI") || !load(choose_config, "eglChooseConfig") ||
            !load(make_context, "eglCreateContext") || !load(make_current, "eglMakeCurrent"))
            return failed("EGL lacks a function");
        void* const display = get_display(nullptr);
        if (!display || !initialize(display, nullptr, nullptr)) return failed("EGL has no display");
        display_ = display;
        if (!bind_api(egl_opengl_api)) return failed("EGL has no OpenGL");
        const int wanted[] = {static_cast<int>(egl_renderable_type), static_cast<int>(egl_opengl_bit),
                              static_cast<int>(egl_surface_type), static_cast<int>(egl_pbuffer_bit),
                              static_cast<int>(egl_none)};
        void* config = nullptr;
        int count = 0;
        if (!choose_config(display_, wanted, &config, 1, &count) || count < 1)
            return failed("EGL has no configuration");
        const int attributes[] = {static_cast<int>(egl_context_profile_mask),
                                  static_cast<int>(egl_context_compatibility_bit), static_cast<int>(egl_none)};
        context_ = make_context(display_, config, nullptr, attributes);
        if (!context_) return failed("EGL makes no compatibility context");
        if (!make_current(display_, nullptr, nullptr, context_)) return failed("the context needs a surface");
        return true;
    }

    bool load_functions() {
        const bool all =
            load(Begin, "glBegin") && load(End, "glEnd") && load(Vertex3fv, "glVertex3fv") &&
            load(Vertex4fv, "glVertex4fv") && load(Normal3fv, "glNormal3fv") && load(TexCoord4fv, "glTexCoord4fv") &&
            load(MatrixMode, "glMatrixMode") && load(LoadIdentity, "glLoadIdentity") &&
            load(LoadMatrixf, "glLoadMatrixf") && load(Enable, "glEnable") && load(Disable, "glDisable") &&
            load(TexGeni, "glTexGeni") && load(TexGenfv, "glTexGenfv") && load(GetTexGeniv, "glGetTexGeniv") &&
            load(GetTexGenfv, "glGetTexGenfv") && load(IsEnabled, "glIsEnabled") && load(GetError, "glGetError") &&
            load(GetString, "glGetString") && load(RenderMode, "glRenderMode") &&
            load(FeedbackBuffer, "glFeedbackBuffer") && load(GenTextures, "glGenTextures") &&
            load(BindTexture, "glBindTexture") && load(TexImage2D, "glTexImage2D") &&
            load(TexParameteri, "glTexParameteri") && load(GenFramebuffers, "glGenFramebuffers") &&
            load(BindFramebuffer, "glBindFramebuffer") && load(FramebufferTexture2D, "glFramebufferTexture2D") &&
            load(CheckFramebufferStatus, "glCheckFramebufferStatus") && load(Viewport, "glViewport") &&
            load(ClampColor, "glClampColor") && load(ClearColor, "glClearColor") && load(Clear, "glClear") &&
            load(ReadPixels, "glReadPixels") && load(CreateShader, "glCreateShader") &&
            load(ShaderSource, "glShaderSource") && load(CompileShader, "glCompileShader") &&
            load(GetShaderiv, "glGetShaderiv") && load(CreateProgram, "glCreateProgram") &&
            load(AttachShader, "glAttachShader") && load(LinkProgram, "glLinkProgram") &&
            load(GetProgramiv, "glGetProgramiv") && load(UseProgram, "glUseProgram") &&
            load(GetShaderInfoLog, "glGetShaderInfoLog") && load(BindAttribLocation, "glBindAttribLocation") &&
            load(GetUniformLocation, "glGetUniformLocation") && load(Uniform1f, "glUniform1f") &&
            load(Uniform3fv, "glUniform3fv") && load(Uniform4fv, "glUniform4fv") &&
            load(UniformMatrix4fv, "glUniformMatrix4fv") && load(TexParameterfv, "glTexParameterfv");
        return all || failed("OpenGL lacks a function");
    }

    bool create_target() {
        unsigned target = 0, target_framebuffer = 0;
        GenTextures(1, &target);
        BindTexture(texture_2d, target);
        TexImage2D(texture_2d, 0, static_cast<int>(rgba32f), width, height, 0, rgba, float_type, nullptr);
        GenFramebuffers(1, &target_framebuffer);
        BindFramebuffer(framebuffer, target_framebuffer);
        FramebufferTexture2D(framebuffer, color_attachment0, texture_2d, target, 0);
        if (CheckFramebufferStatus(framebuffer) != framebuffer_complete) return failed("no target of floats");
        Viewport(0, 0, width, height);
        for (const Enum clamp : {clamp_vertex_color, clamp_fragment_color, clamp_read_color}) ClampColor(clamp, 0);

        // Unit 0 needs a complete texture: without one feedback returns the current coordinate.
        unsigned image = 0;
        GenTextures(1, &image);
        BindTexture(texture_2d, image);
        const float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f};
        TexImage2D(texture_2d, 0, static_cast<int>(rgba), 1, 1, 0, rgba, float_type, texel);
        TexParameteri(texture_2d, texture_min_filter, static_cast<int>(nearest));
        TexParameteri(texture_2d, texture_mag_filter, static_cast<int>(nearest));
        Enable(texture_2d);
        return GetError() == no_error || failed("OpenGL does not take the set-up");
    }

    bool create_program() {
        program_ = program(nullptr, "#version 120\nvoid main() { gl_FragColor = gl_TexCoord[0]; }\n");
        return (program_ != 0 && GetError() == no_error) || failed("GLSL 1.20 does not compile");
    }

    // Never given back: they last as long as the program.
    void* display_ = nullptr;
    void* context_ = nullptr;
    unsigned program_ = 0;
    bool usable_;  // the last member: set by what fills the others
};

}  // namespace support::gl
