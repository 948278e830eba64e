// Whether a page of our own is well-formed: every element closed in order, attributes quoted and named once,
// entities whole, text in UTF-8. Stricter than HTML asks; what passes here is XML too, but for scripts and
// styles.
#pragma once

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ridgeline::test {

class MarkupReader {
  public:
    explicit MarkupReader(std::string_view text) : text_(text) {}

    // Empty, or what is wrong first and where.
    std::string fault() {
        if (!take("<!DOCTYPE html>\n")) return "no doctype";
        while (fault_.empty() && at_ < text_.size()) text_[at_] == '<' ? read_tag() : read_text();
        if (fault_.empty() && !open_.empty()) fail("<" + open_.back() + "> is not closed");
        return fault_;
    }

  private:
    void fail(const std::string& what) {
        const std::size_t from = at_ < 40 ? 0 : at_ - 40;
        if (fault_.empty())
            fault_ = what + " at " + std::to_string(at_) + ": …" + std::string(text_.substr(from, 80));
    }

    bool take(std::string_view part) {
        if (text_.substr(at_, part.size()) != part) return false;
        at_ += part.size();
        return true;
    }

    std::string name() {
        const std::size_t from = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '-'))
            ++at_;
        return std::string(text_.substr(from, at_ - from));
    }

    // Up to `end`, which must come before `wrong`.
    void read_plain(std::string_view end) {
        while (at_ < text_.size() && end.find(text_[at_]) == std::string_view::npos) {
            if (text_[at_] == '<' || text_[at_] == '>') return fail("markup where text is");
            if (text_[at_] == '&') read_entity();
            if (!fault_.empty()) return;
            ++at_;
        }
    }

    void read_entity() {
        for (const std::string_view entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"})
            if (text_.substr(at_, entity.size()) == entity) {
                at_ += entity.size() - 1;
                return;
            }
        fail("a bare ampersand");
    }

    void read_text() {
        if (open_.empty() && text_[at_] != '\n') return fail("text outside the page");
        read_plain("<");
    }

    void read_attributes() {
        std::set<std::string> seen;
        while (take(" ")) {
            const std::string attribute = name();
            if (attribute.empty()) return fail("no attribute's name");
            if (!seen.insert(attribute).second) return fail("a second " + attribute);
            if (attribute.starts_with("on")) return fail("a handler");
            if (!take("=\"")) return fail("an attribute without quotes");
            read_plain("\"");
            if (!take("\"")) return fail("an open quote");
        }
    }

    void read_tag() {
        if (take("</")) {
            const std::string closed = name();
            if (open_.empty() || open_.back() != closed) return fail("</" + closed + "> closes nothing");
            open_.pop_back();
            if (!take(">")) fail("an open tag");
            return;
        }
        take("<");
        const std::string opened = name();
        if (opened.empty()) return fail("a bare <");
        read_attributes();
        if (!fault_.empty() || take("/>")) return;
        if (!take(">")) return fail("an open tag");
        open_.push_back(opened);
        if (opened == "script" || opened == "style")
            at_ = std::min(text_.find("</" + opened, at_), text_.size());
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<std::string> open_;
    std::string fault_;
};

inline std::string markup_fault(std::string_view page) { return MarkupReader(page).fault(); }

}  // namespace ridgeline::test
