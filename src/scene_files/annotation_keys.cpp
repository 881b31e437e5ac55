// SPDX-License-Identifier: Apache-2.0
#include "annotation/font.h"
#include "annotation/numbers.h"
#include "scene_files/scene_keys.h"

namespace lamina {
namespace {

Form<double> size_form() {
    return number_form(
        {.from = Annotation::least_size, .up_to = Annotation::largest_size},
        fmt::format("a number from {} to {}", Annotation::least_size, Annotation::largest_size));
}

void add_place(KeyTable<Annotation>& keys) {
    keys.key("position", &Annotation::position, automatic_words_form<AnnotationPosition>(automatic),
             "A corner, or the middle of an edge; auto: each annotation has its own place.");
    keys.key("size", &Annotation::size, size_form(),
             "Factor on the size, which follows the picture's height.");
}

void add_format(KeyTable<Annotation>& keys) {
    Form<std::string> form = text_form();
    form.read = [](JsonReader& reader, const std::string& key) {
        std::string format = reader.text(key);
        const auto mistake = mistake_in_format(format);
        if (mistake && !format.empty()) reader.fail_at(key, *mistake);
        return format;
    };
    keys.key("format", &Annotation::format, form,
             "Of numbers: one {}, {:.Nf}, {:.Ne} or {:.Ng} with text around it.");
}

void caption_keys(KeyTable<Annotation>& keys) {
    add_place(keys);
    keys.key("text", &Annotation::text, text_form(),
             "Stands above; the data's name and unit if it is left out.");
}

void colorbar_keys(KeyTable<Annotation>& keys) {
    caption_keys(keys);
    add_format(keys);
}

void scale_keys(KeyTable<Annotation>& keys) {
    add_place(keys);
    add_format(keys);
}

void box_keys_of_annotation(KeyTable<Annotation>& keys) {
    keys.key("size", &Annotation::size, size_form(), "Factor on lines and numbers.");
    add_format(keys);
}

void text_keys(KeyTable<Annotation>& keys) {
    keys.key("text", &Annotation::text, text_form(), "Lines are parted by \\n.").required();
    add_place(keys);
}

// The form of an annotation: an object with the keys of `table` or a short form that `is_short`
// tells by its JSON type, `read_short` reads and `short_of` writes, if it says all.
template <typename ReadShort, typename ShortOf>
Form<std::optional<Annotation>> annotation_form(const KeyTable<Annotation>& (*table)(),
                                                bool (nlohmann::json::*is_short)() const noexcept,
                                                const KeyJson& short_schema,
                                                const std::string& expected,
                                                const ReadShort& read_short,
                                                const ShortOf& short_of) {
    const Form<Annotation> object = object_form(table);
    return {[=](JsonReader& reader, const std::string& key) -> std::optional<Annotation> {
                const nlohmann::json& value = reader.value(key);
                if ((value.*is_short)()) return read_short(reader, key);
                if (!value.is_object()) reader.reject(key, expected);
                return object.read(reader, key);
            },
            [=](const std::optional<Annotation>& value) {
                if (!value) return KeyJson();
                const KeyJson shortened = short_of(*value);
                return shortened.is_null() ? object.write(*value) : shortened;
            },
            {{"oneOf", KeyJson::array({short_schema, object.schema})}}};
}

Form<std::optional<Annotation>> switched_form(const KeyTable<Annotation>& (*table)()) {
    return annotation_form(
        table, &nlohmann::json::is_boolean, {{"type", "boolean"}}, "true, false or an object {...}",
        [](JsonReader& reader, const std::string& key) {
            return reader.flag(key) ? std::optional(Annotation{}) : std::nullopt;
        },
        [](const Annotation& value) { return value == Annotation{} ? KeyJson(true) : KeyJson(); });
}

Form<std::optional<Annotation>> titled_form() {
    return annotation_form(
        table_of<text_keys>, &nlohmann::json::is_string, {{"type", "string"}},
        "a text or an object {...}",
        [](JsonReader& reader, const std::string& key) {
            Annotation title;
            title.text = reader.text(key);
            return title.text.empty() ? std::nullopt : std::optional(title);
        },
        [](const Annotation& value) {
            Annotation plain;
            plain.text = value.text;
            return value == plain ? KeyJson(value.text) : KeyJson();
        });
}

void annotation_keys(KeyTable<Annotations>& keys) {
    const auto add = [&](const char* name, std::optional<Annotation> Annotations::*member,
                         const KeyTable<Annotation>& (*table)(), const char* description) {
        keys.key(name, member, switched_form(table), description).otherwise(false);
    };
    add("colorbar", &Annotations::colorbar, table_of<colorbar_keys>,
        "The transfer function's colours and opacities. With \"labels\" beside it: the one that "
        "fits the data.");
    add("labels", &Annotations::labels, table_of<caption_keys>,
        "A legend of the labels that show, by their names or numbers.");
    add("scale_bar", &Annotations::scale_bar, table_of<scale_keys>,
        "A length of the world; in perspective that of the plane through the camera's center.");
    add("axes", &Annotations::axes, table_of<add_place>, "Arrows along the world's axes.");
    add("box", &Annotations::box, table_of<box_keys_of_annotation>,
        "The edges of the data's box, with numbers. The volume does not hide them.");
    keys.key("title", &Annotations::title, titled_form(), "Above the picture's middle.");
    keys.key("texts", &Annotations::texts,
             list_form(table_of<text_keys>, Annotations::most_texts, "texts",
                       {{"maxItems", Annotations::most_texts}}),
             "Further texts.");
}

}  // namespace

Form<Annotations> annotations_form() {
    Form<Annotations> form = object_form(table_of<annotation_keys>);
    form.write = [](const Annotations& all) {
        return all.any() ? table_of<annotation_keys>().json(all) : KeyJson();
    };
    return form;
}

}  // namespace lamina
