#include "texture/endpoints/multipart_form.h"

#include <algorithm>

namespace simwright::texture {

MultipartForm MakeMultipartForm(const std::vector<FormField>& fields) {
  std::string boundary = "simwright-form";
  const auto occurs = [&](const FormField& field) {
    return field.content.find(boundary) != std::string::npos;
  };
  while (std::any_of(fields.begin(), fields.end(), occurs)) boundary += "-0";
  MultipartForm form;
  form.content_type = "multipart/form-data; boundary=" + boundary;
  for (const FormField& field : fields) {
    form.body += "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + field.name + '"';
    if (!field.file_name.empty()) form.body += "; filename=\"" + field.file_name + '"';
    form.body += "\r\n";
    if (!field.content_type.empty()) form.body += "Content-Type: " + field.content_type + "\r\n";
    form.body += "\r\n" + field.content + "\r\n";
  }
  form.body += "--" + boundary + "--\r\n";
  return form;
}

}  // namespace simwright::texture
